//! Real data of one axis (EMPS), where they are: the path of the folder is in `DENAVIT_EMPS`.

use super::{INERTIAL, robot};
use denavit_codegen::model;
use denavit_codegen::regressor::RegressorOptions;
use denavit_identify::estimate::{Options, SlowRows, estimate, parameters, validate};
use denavit_measure::condition::{Conditioned, Conditioning, Filter};
use denavit_measure::log::{ColumnMapping, LogOf, MeasuredLog, read_log};
use denavit_plants::regression::RegressionModel;
use denavit_plants::shipped;
use denavit_plants::{Override, plant_of};
use denavit_replay::{Compared, MotionLog, closed_loop};
use denavit_simulate::scenario::read_controller;
use std::fs::File;
use std::io::BufReader;

/// Published: A. Janot, M. Gautier, M. Brunot, "Data Set and Reference Models of EMPS" (2019).
const PUBLISHED: [(&str, f64, f64); 4] = [
    ("m_carriage", 95.1089, 0.1085),
    ("fv_carriage", 203.5034, 1.146),
    ("fc_carriage", 20.3935, 0.1012),
    ("off_carriage", -3.1648, 0.0444),
];

/// The model and its data, conditioned as published.
struct Axis {
    model: RegressionModel,
    folder: String,
}

impl Axis {
    fn new() -> Self {
        let folder = std::env::var("DENAVIT_EMPS").expect("the folder of the measurements");
        let text = include_bytes!("../../../../models/emps.json");
        let robot = model::read("emps.json", text).expect("a sound model");
        let options = RegressorOptions { friction: true, offset: true, ..INERTIAL };
        Self { model: RegressionModel::new(&robot, options, &[]).expect("a model"), folder }
    }

    fn log(&self, name: &str) -> MeasuredLog {
        let mapping = ColumnMapping::from_json(
            "map",
            br#"{"t": "t_s", "q_carriage": "qm_m", "tau_carriage": "force_N",
                 "ref_carriage": "qg_m"}"#,
        )
        .expect("a sound mapping");
        let file = File::open(format!("{}/{name}", self.folder)).expect(name);
        let of = LogOf {
            model: "emps",
            joints: &self.model.joints,
            contacts: &[],
            accepts_suspicious: false,
        };
        let log = read_log(name, BufReader::new(file), of, &mapping);
        log.unwrap_or_else(|faults| panic!("{faults}"))
    }

    fn conditioned(&self, name: &str) -> Conditioned {
        let how = Conditioning {
            filter: Some(Filter { order: 4, cutoff_hz: 100.0 }),
            decimation: 10,
            ..Conditioning::default()
        };
        Conditioned::new(self.log(name), &["carriage".to_owned()], &how).expect("enough samples")
    }
}

#[test]
#[ignore = "needs the measurements, which are not part of the repository"]
fn the_published_parameters_and_errors_are_reached() {
    let axis = Axis::new();
    let model = &axis.model;
    let train = axis.conditioned("emps_ident.csv");
    let start = vec![0.0; model.rank()];
    let data = std::slice::from_ref(&train);
    // all rows count, as where they were published; then those without reversals
    let of = |slow: SlowRows| {
        let options = Options { slow, ..Options::default() };
        let found = estimate(model, data, &[], &options, &start).expect("an estimate");
        let phi = found.solution.phi.as_slice();
        let errors = [
            validate(model, phi, data).relative,
            validate(model, phi, &[axis.conditioned("emps_pulses.csv")]).relative,
        ];
        println!("{slow:?}: relative errors {:.4?} %", errors.map(|error| 100.0 * error));
        for one in parameters(model, &found) {
            println!("{} {:.4} +- {:.4} {}", one.name, one.value, one.std.unwrap(), one.unit);
        }
        (found, errors)
    };
    let (_, errors) = of(SlowRows::Biasing);
    assert!(errors[0] <= 0.0408 && errors[1] <= 0.0598, "{errors:?}");
    let (found, _) = of(SlowRows::Kept);
    let listed = parameters(model, &found);
    let phi = found.solution.phi.as_slice();
    let fit = validate(model, phi, data).relative;
    let held_out = validate(model, phi, &[axis.conditioned("emps_pulses.csv")]).relative;
    println!("relative errors {:.4} % and {:.4} %", 100.0 * fit, 100.0 * held_out);
    assert!(fit <= 0.0408 && held_out <= 0.0598, "{fit} {held_out}");
    for (name, value, _) in PUBLISHED {
        let ours = listed.iter().find(|one| one.name == name).expect(name);
        assert!((ours.value - value).abs() < 0.03 * value.abs(), "{name}: {}", ours.value);
    }
    let simulated = [("emps_ident.csv", 0.05848, 1.38e-4), ("emps_pulses.csv", 0.089409, 5.6e-4)];
    for (name, published_force, published_position) in simulated {
        let of = |name: &str| listed.iter().find(|one| one.name == name).expect(name).value;
        let values = PUBLISHED.map(|(name, ..)| (name, of(name)));
        let [force, position] = closed_loop_errors(&axis.log(name), &values);
        println!(
            "{name}: closed loop {:.3} % force, {:.4} % position",
            force * 1e2,
            position * 1e2
        );
        // Pulses are an input of the second log that its file does not scale.
        if name == "emps_ident.csv" {
            assert!(force < published_force, "{name} {force}");
            assert!(position < published_position, "{name} {position}");
        }
        assert!(position < 0.005, "{name} {position}");
    }
}

/// Relative errors of force and position, unfiltered, when the model moves under the controller of
/// the axis.
fn closed_loop_errors(log: &MeasuredLog, values: &[(&str, f64)]) -> [f64; 2] {
    let overrides: Vec<Override> = values
        .iter()
        .map(|&(name, value)| Override { parameter: name.to_owned(), value })
        .collect();
    let mut plant = plant_of(&robot("emps"), &overrides).expect("a plant");
    let shipped = shipped::find_controller("emps").expect("shipped");
    let load = |_: &str| Err("no such file".to_owned());
    let read = read_controller("emps", shipped.text.as_bytes(), plant.model(), &load);
    let controller = read.unwrap_or_else(|error| panic!("{error}"));
    let mut motion = MotionLog::new(log, &["carriage".to_owned()], None).expect("enough samples");
    // an encoder that shows 4e-5 m/s from sample to sample sees friction as a step
    motion.stiction_rate = 1e-4;
    let found = closed_loop(plant.as_mut(), None, &controller, &motion).expect("a comparison");
    let joint = &found.joints[0];
    let relative = |compared: &Compared| {
        let size = compared.measured.iter().map(|value| value * value).sum::<f64>();
        (compared.residual().map(|error| error * error).sum::<f64>() / size).sqrt()
    };
    [relative(joint.torque.as_ref().expect("measured")), relative(&joint.position)]
}
