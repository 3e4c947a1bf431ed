//! The double pendulum of the thesis twice: with its joints as explicit constraints (2.2.1), and in
//! minimal coordinates. Prints how far the joints come apart, without and with Baumgarte's terms.
//!
//!     cargo run --release --example constraint_drift

use denavit::model;
use denavit::plants::InterpretedPlant;
use denavit::report::{Align, Table};
use denavit::shipped;
use denavit::simulate::constraint_drift::ConstrainedBodies;
use std::error::Error;

/// Steps of the classical method of Runge and Kutta \[s\].
const STEP_S: f64 = 5e-3;
/// Rate at which Baumgarte's terms let errors decay [1/s].
const RATE: f64 = 20.0;

fn main() -> Result<(), Box<dyn Error>> {
    let shipped = shipped::find("double_pendulum").ok_or("a shipped model")?;
    let robot = model::read(shipped.name, shipped.text.as_bytes())?;
    let mut plant = InterpretedPlant::new(&robot, &[])?;
    let mut run = |rate: f64| {
        ConstrainedBodies::new(&robot, rate)
            .map_err(|error| Box::new(error) as Box<dyn Error>)
            .and_then(|mut bodies| Ok(bodies.run(&mut plant, &[-1.2, 0.3], STEP_S, 0.1, 200)?))
    };
    let (free, held) = (run(0.0)?, run(RATE)?);
    let mut table = Table::new(&[
        ("t [s]", Align::Right),
        ("constraints [m]", Align::Right),
        ("their rates [m/s]", Align::Right),
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
    Ok(())
}
