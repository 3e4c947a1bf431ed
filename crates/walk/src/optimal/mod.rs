//! Limit cycles by periodic optimal control.

mod cost;
mod guess;
mod interval_rows;
mod layout;
mod legs;
mod limits;
mod mechanics;
mod phases;
mod point_rows;
mod program;
mod quadratic;
mod rows;
mod sparse;
mod sqp;
mod step;
mod transition_rows;

pub mod trial {
    use super::cost::CostKind;
    use super::guess::Guess;
    use super::legs::Legs;
    use super::layout::Layout;
    use super::limits::StepLimits;
    use super::phases::{Aspects, phases_of};
    use super::program::violation;
    use super::sqp::{Settings, minimise};
    use super::step::{Step, settings_of};
    pub fn run(speed: f64, intervals: usize, iterations: usize) {
        let mut plant = denavit_plants::planar_biped(&[]).unwrap();
        let legs = Legs::of(plant.as_mut()).unwrap();
        let phases = phases_of(Aspects::default());
        let limits = StepLimits { speed_m_s: speed, ..StepLimits::default() };
        let counts = Layout::shared_out(&phases, intervals);
        let mut x: Option<Vec<f64>> = None;
        for (kind, rounding) in [(CostKind::TorqueSquared, 0.01), (CostKind::CostOfTransport, 0.02), (CostKind::CostOfTransport, 0.003)] {
            let t0 = std::time::Instant::now();
            let mut step = Step::new(plant.as_mut(), &legs, (&phases, &counts), limits, settings_of(kind, rounding));
            let start = x.clone().unwrap_or_else(|| step.guess(Guess::default()));
            println!("variables {} constraints {}", step.layout.variables, step.labels().len());
            let found = minimise(&mut step, &start, Settings { iterations, ..Settings::default() });
            println!("{kind:?}: cost {} violation {} {:?} after {} in {:?}", found.cost, found.violation, found.ending, found.iterations, t0.elapsed());
            let labels = step.labels();
            let ranges = super::program::Program::ranges(&step);
            let mut worst: Vec<(f64, usize)> = found.constraints.iter().zip(ranges).enumerate().map(|(i, (v, r))| (violation(*v, *r), i)).collect();
            worst.sort_by(|a, b| b.0.total_cmp(&a.0));
            for (v, i) in worst.iter().take(4) {
                println!("   {v:.2e} {:?}", labels[*i]);
            }
            let l = &step.layout;
            println!("   durations {:?} length {} ", &found.x[l.durations..l.durations + l.phases.len()], found.x[l.length]);
            for (i, p) in l.points.iter().enumerate().filter(|(i, _)| i % 4 == 0) {
                let q = &found.x[p.start..p.start + 9];
                let tau = &found.x[l.torques(p)..l.torques(p) + 6];
                println!("   {i:3} ph{} q {} tau {} f {}", p.phase, text(q), text(tau), text(&found.x[l.forces(p)..l.forces(p) + l.held[p.phase].len()]));
            }
            x = Some(found.x);
        }
    }
    fn text(v: &[f64]) -> String {
        v.iter().map(|x| format!("{x:7.3}")).collect::<Vec<_>>().join(" ")
    }
}
