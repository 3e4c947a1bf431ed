//! The double pendulum of the thesis twice: with its joints as explicit constraints (2.2.1), and in
//! minimal coordinates. Prints how far the joints come apart, without and with Baumgarte's terms,
//! and draws it.
//!
//!     cargo run --release --example constraint_drift -- docs/evidence/constraint-drift.svg

use denavit::model;
use denavit::plants::LoadedPlant;
use denavit::report::{Align, Table};
use denavit::shipped;
use denavit::simulate::constraint_drift::{ConstrainedBodies, DriftSample};
use std::error::Error;

/// Steps of the classical method of Runge and Kutta \[s\].
const STEP_S: f64 = 5e-3;
/// Rate at which Baumgarte's terms let errors decay [1/s].
const RATE: f64 = 20.0;

fn main() -> Result<(), Box<dyn Error>> {
    let shipped = shipped::find("double_pendulum").ok_or("a shipped model")?;
    let robot = model::read(shipped.name, shipped.text.as_bytes())?;
    let mut plant = LoadedPlant::new(&robot, &[])?;
    let mut run = |rate: f64| {
        ConstrainedBodies::new(&robot, rate)
            .map_err(|error| Box::new(error) as Box<dyn Error>)
            .and_then(|mut bodies| Ok(bodies.run(&mut plant, &[-1.2, 0.3], STEP_S, 0.1, 200)?))
    };
    let (free, held) = (run(0.0)?, run(RATE)?);
    let mut table = Table::new(&[
        ("t [s]", Align::Right),
        ("constraints [m]", Align::Right),
        ("their velocities [m/s]", Align::Right),
        ("Baumgarte [m]", Align::Right),
        ("minimal: energy [J]", Align::Right),
    ]);
    for (free, held) in free.iter().zip(&held).step_by(20).skip(1) {
        table.push(vec![
            format!("{:.0}", free.t_s),
            format!("{:.2e}", free.constraint),
            format!("{:.2e}", free.constraint_rate),
            format!("{:.2e}", held.constraint),
            format!("{:.2e}", free.minimal_energy_j),
        ]);
    }
    print!("{table}");
    if let Some(file) = std::env::args().nth(1) {
        let points = |drift: &[DriftSample]| -> Vec<[f64; 2]> {
            drift.iter().skip(1).map(|sample| [sample.t_s, sample.constraint]).collect()
        };
        std::fs::write(file, svg(&points(&free), &points(&held)))?;
    }
    Ok(())
}

/// The error of the joints over time, both axes logarithmic.
fn svg(free: &[[f64; 2]], held: &[[f64; 2]]) -> String {
    let x = |t_s: f64| 70.0 + 410.0 * (t_s / 0.1).log10() / 200f64.log10();
    let y = |metres: f64| 300.0 - 260.0 * (metres.max(1e-13) / 1e-13).log10() / 7.0;
    let mut text = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"520\" height=\"350\" \
         font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"520\" height=\"350\" fill=\"white\"/>\n",
    );
    for exponent in -13..=-6 {
        let at = y(10f64.powi(exponent));
        text += &format!("<path d=\"M70 {at:.1}H480\" stroke=\"#ddd\"/>\n");
        let place = format!("x=\"64\" y=\"{:.1}\" text-anchor=\"end\"", at + 4.0);
        text += &format!("<text {place}>1e{exponent}</text>\n");
    }
    for t_s in [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0] {
        let at = x(t_s);
        text += &format!("<path d=\"M{at:.1} 40V300\" stroke=\"#ddd\"/>\n");
        text += &format!("<text x=\"{at:.1}\" y=\"316\" text-anchor=\"middle\">{t_s}</text>\n");
    }
    text += "<text x=\"275\" y=\"338\" text-anchor=\"middle\">time [s]</text>\n\
             <text x=\"70\" y=\"24\">joints are apart by [m]: \
             <tspan fill=\"#b33\">as accelerations alone</tspan>, \
             <tspan fill=\"#26a\">with Baumgarte's terms</tspan></text>\n";
    for (points, colour) in [(free, "#b33"), (held, "#26a")] {
        let places: Vec<String> = points
            .iter()
            .map(|[t_s, metres]| format!("{:.1},{:.1}", x(*t_s), y(*metres)))
            .collect();
        text += &format!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\"/>\n",
            places.join(" ")
        );
    }
    text + "</svg>\n"
}
