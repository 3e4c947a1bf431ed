fn main() {
    let a: Vec<String> = std::env::args().collect();
    denavit_walk::optimal::trial::run(a[1].parse().unwrap());
}
