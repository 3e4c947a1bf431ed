fn main() {
    let a: Vec<String> = std::env::args().collect();
    let f = |i: usize, d: f64| a.get(i).and_then(|s| s.parse().ok()).unwrap_or(d);
    denavit_walk::optimal::trial::run(f(1, 0.687), f(2, 20.0) as usize, f(3, 60.0) as usize, f(4, 0.02));
}
