//! The project is its own first client: these robots become modules of Rust. All others are read
//! at run time.

fn main() {
    for model in ["puma560", "tulip"] {
        denavit_codegen::build_script::emit(format!("models/{model}.json"));
    }
}
