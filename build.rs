//! The project is its own first client: these robots become modules of Rust, tulip_leg6 for the
//! benches alone. All others are read at run time.

fn main() {
    for model in ["puma560", "tulip", "tulip_leg6"] {
        denavit_codegen::build_script::emit(format!("models/{model}.json"));
    }
}
