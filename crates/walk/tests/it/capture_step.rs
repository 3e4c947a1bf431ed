use super::scenario;
use denavit_plants::PointModel;
use denavit_walk::capturability::Capturability;
use denavit_walk::capture_step::CaptureStepLaw;
use denavit_walk::robustness::{CapturePushOptions, capture_pushes};

const NAME: &str = "planar_biped_capture_step";

#[test]
fn experiment() {
    let base = scenario(NAME);
    let law = base.control.planning.as_ref().unwrap().law::<CaptureStepLaw>().unwrap();
    let found = Capturability::new(law.limits()).unwrap();
    for n in 0..5 {
        println!("d_{n} {:?}", found.reach_m(n));
    }
    println!("d_oo {:?}", found.limit_m());
    let model = base.plant.model();
    let link = model.links.iter().position(|link| link == "base_pitch").unwrap();
    let point = PointModel { name: "hip".to_owned(), link, position: [0.0; 3] };
    let list: Vec<f64> = std::env::var("PUSHES").map_or_else(
        |_| (-14..=14).map(|k| 2.0 * f64::from(k)).collect(),
        |text| text.split(',').map(|t| t.parse().unwrap()).collect(),
    );
    let options = CapturePushOptions { point, at_s: 0.5, impulses_ns: list, after_s: 4.0 };
    for push in capture_pushes(&|| Some(scenario(NAME)), &found, &options, &|_, _| {}) {
        println!(
            "{:6.1} c {:.4} {:?} steps {} margin {:.4} {:?} agrees {}",
            push.impulse_ns,
            push.capture_m,
            push.predicted,
            push.steps,
            push.margin_m,
            push.outcome,
            push.agrees()
        );
    }
}
