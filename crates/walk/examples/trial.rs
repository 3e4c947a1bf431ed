//! Designs a shipped gait, or one with another speed.
use denavit_walk::optimal::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let speed: f64 = a[1].parse().unwrap();
    let env =
        |name: &str, d: f64| std::env::var(name).ok().and_then(|t| t.parse().ok()).unwrap_or(d);
    let mut plant = denavit_plants::planar_biped(&[]).unwrap();
    let aspects = Aspects {
        retraction: env("RE", 1.0) > 0.0,
        heel_strike: env("HS", 1.0) > 0.0,
        push_off: env("PO", 1.0) > 0.0,
        lean: env("LE", 1.0) > 0.0,
        knee_flexion: env("KF", 1.0) > 0.0,
    };
    let limits = StepLimits {
        speed_m_s: speed,
        step_length_m: std::env::var("L").ok().and_then(|t| t.parse().ok()),
        ..StepLimits::default()
    };
    let problem = LimitCycleProblem {
        limits,
        aspects,
        intervals: env("N", 24.0) as usize,
        ..LimitCycleProblem::default()
    };
    let t0 = std::time::Instant::now();
    match design(plant.as_mut(), &problem) {
        Err(e) => println!("{speed}: {e} {:?}", t0.elapsed()),
        Ok(g) => {
            println!(
                "{speed}: length {:.3} period {:.3} gains {:?} multipliers {:?} cot {:.3} (plan {:.3}) tau2 {:.0} (plan {:.0}) torque {:.1} steps {} speed {:.4} in {:?}",
                g.step.length_m,
                g.step.period_s,
                g.gains,
                &g.cycle.multipliers[..3],
                g.walk.cost_of_transport,
                g.planned_cost_of_transport,
                g.walk.torque_squared,
                g.planned_torque_squared,
                g.walk.torque_nm,
                g.walk.steps,
                g.walk.speed_m_s,
                t0.elapsed()
            );
            for s in &g.stages {
                println!("   {s:?}");
            }
            for p in &g.step.phases {
                println!("   {} {:.3}", p.name, p.duration_s);
            }
            if let Ok(path) = std::env::var("OUT") {
                let head = ScenarioHead {
                    name: "planar_biped_designed",
                    description: "",
                    source: "",
                    model: "planar_biped",
                    steps: 50,
                };
                std::fs::write(path, scenario_text(&g, plant.model(), &head)).unwrap();
            }
        }
    }
}
