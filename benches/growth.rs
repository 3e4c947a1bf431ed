//! How the time for base parameters grows with the joints of random trees.
//!
//! `cargo bench --bench growth` prints a table; `cargo bench --bench growth -- --svg FILE` draws
//! it too. One thread; the median of five trees for each number of joints, each the best of three.

#[path = "../codegen/tests/it/trees.rs"]
mod trees;

use denavit::model;
use denavit::regressor::{RegressorOptions, base_parameters};
use std::time::Instant;

const JOINTS: [usize; 9] = [2, 5, 10, 15, 20, 30, 40, 50, 60];

/// One row: joints, columns, rank, milliseconds.
struct Row {
    joints: usize,
    columns: usize,
    rank: usize,
    milliseconds: f64,
}

fn measured(joints: usize) -> Row {
    let mut trees: Vec<Row> = (0..5)
        .map(|seed| {
            let file = trees::random_tree(joints, 1000 + seed);
            let robot = model::read("random", &file).expect("the model is right");
            let mut best = f64::INFINITY;
            let mut found = None;
            for _ in 0..3 {
                let start = Instant::now();
                found = base_parameters(&robot, RegressorOptions::default(), &[]).ok();
                best = best.min(1e3 * start.elapsed().as_secs_f64());
            }
            let base = found.expect("random trees have base parameters");
            let columns = base.regressor.columns.len();
            Row { joints, columns, rank: base.rank(), milliseconds: best }
        })
        .collect();
    trees.sort_by(|a, b| a.milliseconds.total_cmp(&b.milliseconds));
    trees.swap_remove(2)
}

/// Both axes logarithmic.
fn svg(rows: &[Row]) -> String {
    let x = |joints: f64| 60.0 + 420.0 * (joints / 2.0).ln() / 30f64.ln();
    let y = |ms: f64| 300.0 - 260.0 * (ms / 0.1).ln() / 1e5f64.ln();
    let mut text = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"520\" height=\"350\" \
         font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"520\" height=\"350\" fill=\"white\"/>\n",
    );
    for ms in [0.1, 1.0, 10.0, 100.0, 1000.0, 10000.0] {
        let at = y(ms);
        text += &format!("<path d=\"M60 {at:.1}H480\" stroke=\"#ddd\"/>\n");
        text += &format!("<text x=\"54\" y=\"{:.1}\" text-anchor=\"end\">{ms}</text>\n", at + 4.0);
    }
    for joints in [2.0, 5.0, 10.0, 20.0, 40.0, 60.0] {
        let at = x(joints);
        text += &format!("<path d=\"M{at:.1} 40V300\" stroke=\"#ddd\"/>\n");
        text += &format!("<text x=\"{at:.1}\" y=\"316\" text-anchor=\"middle\">{joints}</text>\n");
    }
    text += "<text x=\"270\" y=\"338\" text-anchor=\"middle\">joints</text>\n\
             <text x=\"60\" y=\"24\">base parameters of random trees [ms]; dashed: target</text>\n";
    let target = y(2000.0);
    text +=
        &format!("<path d=\"M60 {target:.1}H480\" stroke=\"#b33\" stroke-dasharray=\"6 4\"/>\n");
    let points: Vec<String> = rows
        .iter()
        .map(|row| format!("{:.1},{:.1}", x(row.joints as f64), y(row.milliseconds)))
        .collect();
    text += &format!(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#26a\" stroke-width=\"2\"/>\n",
        points.join(" ")
    );
    for point in &points {
        let (x, y) = point.split_once(',').expect("a pair");
        text += &format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"3\" fill=\"#26a\"/>\n");
    }
    text + "</svg>\n"
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let rows: Vec<Row> = JOINTS.into_iter().map(measured).collect();
    println!("| joints | columns | base parameters | ms |\n|---:|---:|---:|---:|");
    for Row { joints, columns, rank, milliseconds } in &rows {
        println!("| {joints} | {columns} | {rank} | {milliseconds:.1} |");
    }
    if let Some(at) = arguments.iter().position(|argument| argument == "--svg") {
        let file = arguments.get(at + 1).expect("--svg FILE");
        std::fs::write(file, svg(&rows)).expect("the file is written");
    }
}
