//! Real data of one axis (EMPS), where they are: the path of the folder is in `DENAVIT_EMPS`.

use super::INERTIAL;
use denavit::identify::condition::{Conditioned, Conditioning, Filter};
use denavit::identify::estimate::{Options, estimate, parameters, validate};
use denavit::identify::log::{ColumnMapping, LogOf, MeasuredLog, read_log};
use denavit::model;
use denavit::plants::regression::RegressionModel;
use denavit::regressor::RegressorOptions;
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
        let text = include_bytes!("../../../models/emps.json");
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
    let found = estimate(model, data, &[], &Options::default(), &start).expect("an estimate");
    let listed = parameters(model, &found);
    for one in &listed {
        println!("{} {:.4} +- {:.4} {}", one.name, one.value, one.std.unwrap(), one.unit);
    }
    let phi = found.solution.phi.as_slice();
    let fit = validate(model, phi, data).relative;
    let held_out = validate(model, phi, &[axis.conditioned("emps_pulses.csv")]).relative;
    println!("relative errors {:.4} % and {:.4} %", 100.0 * fit, 100.0 * held_out);
    assert!(fit <= 0.0408 && held_out <= 0.0598, "{fit} {held_out}");
    for (name, value, _) in PUBLISHED {
        let ours = listed.iter().find(|one| one.name == name).expect(name);
        assert!((ours.value - value).abs() < 0.03 * value.abs(), "{name}: {}", ours.value);
    }
    for (name, published) in [("emps_ident.csv", 0.05848), ("emps_pulses.csv", 0.089409)] {
        let of = |name: &str| listed.iter().find(|one| one.name == name).expect(name).value;
        let values = PUBLISHED.map(|(name, ..)| of(name));
        let [force, position] = closed_loop(&axis.log(name), values);
        println!(
            "{name}: closed loop {:.3} % force, {:.4} % position",
            force * 1e2,
            position * 1e2
        );
        // Pulses are an input of the second log that its file does not scale.
        let is_known = name == "emps_ident.csv";
        assert!(!is_known || force < 1.1 * published, "{name} {force}");
        assert!(position < 0.005, "{name} {position}");
    }
}

/// Relative errors of force and position when the model moves under the controller of the axis.
fn closed_loop(log: &MeasuredLog, [mass, viscous, coulomb, offset]: [f64; 4]) -> [f64; 2] {
    const GAIN_N_PER_V: f64 = 35.150_651_88;
    const PROPORTIONAL: f64 = 160.18;
    const VELOCITY: f64 = 243.45;
    const SUBSTEPS: usize = 20;
    let joint = &log.joints[0];
    let reference = joint.reference.as_ref().expect("mapped");
    let force = joint.tau.as_ref().expect("mapped");
    let (mut q, mut qd) = (joint.q[0], 0.0);
    let mut before = [q, q];
    let (mut apart, mut sizes) = ([0.0; 2], [0.0; 2]);
    for k in 0..log.samples() {
        let rate = (q - before[1]) / (2.0 * log.step_s);
        before = [q, before[0]];
        let volts = PROPORTIONAL * VELOCITY * (reference[k] - q) - VELOCITY * rate;
        let pushed = GAIN_N_PER_V * volts.clamp(-10.0, 10.0);
        for (place, (ours, theirs)) in [(pushed, force[k]), (q, joint.q[k])].into_iter().enumerate()
        {
            apart[place] += (ours - theirs) * (ours - theirs);
            sizes[place] += theirs * theirs;
        }
        let h = log.step_s / SUBSTEPS as f64;
        for _ in 0..SUBSTEPS {
            // Friction takes from the rate what it can, and never turns it round.
            let free = (qd + h * (pushed - offset) / mass) / (1.0 + h * viscous / mass);
            let stop = h * coulomb / mass;
            qd = free.signum() * (free.abs() - stop).max(0.0);
            q += h * qd;
        }
    }
    [0, 1].map(|place| f64::sqrt(apart[place] / sizes[place]))
}
