//! A robot on the ground: what its steps say of its bodies (thesis 3.3, 5.2.1).

use super::{INERTIAL, robot};
use denavit::identify::estimate::{Options, Status, estimate, parameters, validate};
use denavit::measure::condition::{Conditioned, Conditioning, Filter};
use denavit::measure::log::{ColumnMapping, LogOf, MeasuredLog, read_log};
use denavit::numerics::Random;
use denavit::plants::plant_of;
use denavit::plants::regression::RegressionModel;
use denavit::replay::add_contact_forces;
use denavit::shipped;
use denavit::simulate::scenario::{self, RunScheme};

/// Deviation of each component of a force that is measured \[N\].
const FORCE_NOISE_N: f64 = 0.5;

/// TUlip's step of thesis 2.3.5 of this length: the pose of the torso, the joints, forces of the
/// eight points of its feet. `load` gives the files that the scenario refers to.
pub(crate) fn walked(
    model: &RegressionModel,
    length_m: f64,
    load: &scenario::Loader<'_>,
) -> MeasuredLog {
    let shipped = shipped::find_scenario("tulip_step").expect("shipped");
    let mut text: serde_json::Value = serde_json::from_str(shipped.text).expect("JSON");
    text["gait"]["divergent_component"]["footsteps"][0]["forward_m"] = length_m.into();
    let read = denavit::walk::read_scenario(shipped.name, text.to_string().as_bytes(), load);
    let mut scenario = read.unwrap_or_else(|error| panic!("{error}"));
    scenario.scheme = RunScheme::TimeStepping;
    scenario.simulation.log_period_s = scenario.stepping.step_s;
    let run = scenario.run().unwrap_or_else(|error| panic!("{error}"));
    let contacts: Vec<String> =
        scenario.plant.model().contacts.iter().map(|contact| contact.name.clone()).collect();
    let of = LogOf {
        model: &model.model,
        joints: &model.joints,
        contacts: &contacts,
        accepts_suspicious: true,
    };
    let csv = run.log.to_csv();
    let log = read_log("step.csv", csv.as_bytes(), of, &ColumnMapping::default());
    log.unwrap_or_else(|faults| panic!("{faults}"))
}

/// The same as instruments see it.
fn step(model: &RegressionModel, length_m: f64, seed: u64) -> MeasuredLog {
    let load = |name: &str| {
        let found = shipped::find_referred(name).ok_or("no such file")?;
        Ok(found.text.as_bytes().to_vec())
    };
    let mut log = walked(model, length_m, &load);
    let mut random = Random::new(seed);
    for force in log.contacts.iter_mut().flat_map(|(_, axes)| axes) {
        force.iter_mut().for_each(|force| *force += FORCE_NOISE_N * random.normal());
    }
    log
}

/// A step conditioned, with the wrench on the base alone: no torque of any joint is used.
fn conditioned(model: &RegressionModel, length_m: f64, seed: u64) -> Conditioned {
    let mut log = step(model, length_m, seed);
    for joint in &mut log.joints {
        joint.tau = None;
    }
    let is_base: Vec<bool> = model.joints.iter().map(|joint| joint.is_base).collect();
    let mut plant = plant_of(&robot("tulip"), &[]).expect("a plant");
    add_contact_forces(&mut log, plant.as_mut(), &is_base);
    let names: Vec<String> = model.joints.iter().map(|joint| joint.name.clone()).collect();
    let how = Conditioning {
        filter: Some(Filter { order: 4, cutoff_hz: 10.0 }),
        decimation: 20,
        ..Conditioning::default()
    };
    Conditioned::new(log, &names, &how).expect("long enough")
}

/// One step shows few of the 94 parameters of the whole robot: these are right within their errors,
/// the others have errors that say so, and all together they explain another step as well as the
/// true ones do.
#[test]
fn a_step_shows_the_parameters_that_it_excites() {
    let model = RegressionModel::new(&robot("tulip"), INERTIAL, &[]).expect("a regression");
    let train = [conditioned(&model, 0.1, 3)];
    let other = [conditioned(&model, 0.07, 4)];
    let truth = model.model_axes().expect("the model has values");
    let found = estimate(&model, &train, &[], &Options::default(), &truth).expect("an estimate");
    let phi = found.solution.phi.as_slice();

    // on the joint axes, where each parameter is of a joint and what it carries
    let (mut shown, mut hidden, mut within) = (0, 0, 0);
    for (place, axis) in model.axes.iter().enumerate() {
        let std = found.covariance[(place, place)].sqrt();
        let apart = (phi[place] - truth[place]).abs() / std;
        within += usize::from(apart < 3.0);
        if std < 0.05 * truth[place].abs() {
            shown += 1;
            println!("{}: {} for {}, {std:.1e}", axis.name, phi[place], truth[place]);
            assert!(apart < 4.0, "{}: {} for {}", axis.name, phi[place], truth[place]);
        }
        hidden += usize::from(std > truth[place].abs());
    }
    println!("{shown} of {} are shown, {hidden} are not", model.rank());
    assert!(shown >= 2 && hidden >= 47, "{shown} {hidden}");
    assert!(100 * within >= 95 * model.rank(), "{within}");
    let listed = parameters(&model, &found);
    let uncertain = listed.iter().filter(|one| one.status != Status::Identified).count();
    assert!(uncertain >= 47, "{uncertain}");

    // six components of the wrench, weight 248 N
    for (logs, slack) in [(&train, 1.0), (&other, 2.0)] {
        let [ours, theirs] = [phi, &truth].map(|phi| validate(&model, phi, logs));
        assert_eq!(ours.joints.len(), 6);
        println!("left {} and {} with the true values", ours.relative, theirs.relative);
        assert!(ours.relative < slack * theirs.relative + 1e-9);
    }
}
