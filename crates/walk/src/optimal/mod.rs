//! Limit cycles by periodic optimal control.

mod cost;
mod design;
mod following;
mod gains;
mod guess;
mod interval_rows;
mod layout;
mod legs;
mod limits;
mod mechanics;
mod phases;
mod planned;
mod point_rows;
mod program;
mod quadratic;
mod rows;
mod section;
mod sparse;
mod sqp;
mod stance_foot;
mod step;
mod transition_rows;

pub mod trial {
    use super::design::*;
    use super::limits::StepLimits;
    pub fn run(speed: f64) {
        let mut plant = denavit_plants::planar_biped(&[]).unwrap();
        let env = |name: &str, d: f64| std::env::var(name).ok().and_then(|t| t.parse().ok()).unwrap_or(d);
        let aspects = super::phases::Aspects { retraction: env("RE", 1.0) > 0.0, heel_strike: env("HS", 1.0) > 0.0, push_off: env("PO", 1.0) > 0.0, lean: env("LE", 1.0) > 0.0, knee_flexion: env("KF", 1.0) > 0.0 };
        let problem = LimitCycleProblem {
            limits: StepLimits { speed_m_s: speed, contact_force: env("CF", 0.1), touchdown_m_s: env("TD", 0.1), phase_s: env("PH", 0.05), ..StepLimits::default() },
            aspects, intervals: env("N", 24.0) as usize,
            ..LimitCycleProblem::default()
        };
        let t0 = std::time::Instant::now();
        match design(plant.as_mut(), &problem) {
            Err(e) => println!("{speed}: {e} {:?}", t0.elapsed()),
            Ok(g) => {
                println!("{speed}: length {:.3} period {:.3} gains {:?} multipliers {:?} cot {:.3} (plan {:.3}) tau2 {:.0} (plan {:.0}) torque {:.1} steps {} speed {:.4} in {:?}", g.step.length_m, g.step.period_s, g.gains, &g.cycle.multipliers[..3], g.walk.cost_of_transport, g.planned_cost_of_transport, g.walk.torque_squared, g.planned_torque_squared, g.walk.torque_nm, g.walk.steps, g.walk.speed_m_s, t0.elapsed());
                for s in &g.stages { println!("   {s:?}"); }
                for p in &g.step.phases { println!("   {} {:.3}", p.name, p.duration_s); }
            }
        }
    }
}
