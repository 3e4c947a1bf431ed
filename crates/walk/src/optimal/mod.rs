//! Limit cycles by periodic optimal control.

mod cost;
mod following;
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
    use super::cost::CostKind;
    use super::guess::Guess;
    use super::legs::Legs;
    use super::layout::Layout;
    use super::limits::StepLimits;
    use super::phases::{Aspects, phases_of};
    use super::program::violation;
    use super::sqp::{Settings, minimise};
    use super::step::{Step, settings_of};
    pub fn run(speed: f64, intervals: usize, iterations: usize, rounding: f64) {
        let mut plant = denavit_plants::planar_biped(&[]).unwrap();
        let legs = Legs::of(plant.as_mut()).unwrap();
        let phases = phases_of(Aspects::default());
        let env = |name: &str, d: f64| std::env::var(name).ok().and_then(|t| t.parse().ok()).unwrap_or(d);
        let limits = StepLimits { speed_m_s: speed, contact_force: env("CF", 0.1), touchdown_m_s: env("TD", 0.1), phase_s: env("PH", 0.05), clearance_m: env("CL", 0.02), ..StepLimits::default() };
        let counts = Layout::shared_out(&phases, intervals);
        let mut x: Option<Vec<f64>> = None;
        for (kind, rounding) in [(CostKind::TorqueSquared, 0.01), (CostKind::CostOfTransport, rounding)] {
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
            println!("   impulses {}", text(&found.x[l.durations + l.phases.len()..l.length]));
            println!("   durations {:?} length {} ", &found.x[l.durations..l.durations + l.phases.len()], found.x[l.length]);
            for (i, p) in l.points.iter().enumerate().filter(|(i, _)| i % 4 == 0) {
                let q = &found.x[p.start..p.start + 9];
                let tau = &found.x[l.torques(p)..l.torques(p) + 6];
                println!("   {i:3} ph{} q {} tau {} f {}", p.phase, text(q), text(tau), text(&found.x[l.forces(p)..l.forces(p) + l.held[p.phase].len()]));
            }
            let planned = super::planned::PlannedStep::of(&step, &found.x);
            x = Some(found.x);
            drop(step);
            if kind == CostKind::TorqueSquared && env("ONLY", 0.0) == 1.0 { continue; }
            for (k, z) in [(0.0, 500.0), (0.0, 800.0), (10.0, 0.2), (10.0, 0.4), (15.0, 0.1), (15.0, 0.2), (15.0, 0.4), (20.0, 0.1), (20.0, 0.2), (20.0, 0.4), (20.0, 0.7), (30.0, 0.3)] {
                let gains = if k == 0.0 { super::following::Gains { carrying: [z; 3], flying: [z; 3], damping_s: 0.015 } } else { super::following::Gains::of_frequency(plant.as_mut(), &planned, k, z).unwrap() };
                if env("EV", 0.0) == 1.0 { println!("{gains:?}"); }
                let t0 = std::time::Instant::now();
                let mut section = super::section::Section::new(plant.as_mut(), &planned, &gains).unwrap();
                let zz = section.planned().unwrap();
                let state = section.state(&zz);
                if env("CMP", 0.0) == 1.0 {
                    let mut state = section.state(&zz);
                    let control = super::following::control(plant.as_mut(), &planned, &gains).unwrap();
                    let sim = super::following::simulation(state.t_s + planned.period_s, 0.01);
                    let run = denavit_simulate::simulate(plant.as_mut(), &control, &state, &sim).unwrap();
                    let t = run.log.column("t").unwrap();
                    for (row, t) in t.iter().enumerate() {
                        let swaps = *t > planned.period_s;
                        let [q, qd, _] = planned.motion(if swaps { t - planned.period_s } else { *t }).unwrap();
                        let [q, qd] = [q, qd].map(|v| if swaps { planned.legs.swap(&v) } else { v });
                        let col = |n: String| run.log.column(&n).unwrap()[row];
                        let names: Vec<String> = plant.model().joints.iter().map(|j| j.name.clone()).collect();
                        let dq: Vec<f64> = (0..9).map(|i| col(format!("q_{}", names[i])) - q[i]).collect();
                        let dv: Vec<f64> = (0..9).map(|i| col(format!("qd_{}", names[i])) - qd[i]).collect();
                        let f: Vec<f64> = ["right_heel", "right_toe", "left_heel", "left_toe"].iter().map(|n| col(format!("f_{n}_z"))).collect();
                        println!("  t {:.4} dq {} dv {} f {}", t, text(&dq[2..]), text(&dv[2..]), text(&f));
                    }
                    for e in &run.events { println!("    {:.4} {:?} {:?} {:?} {}", e.t_s, e.kind, e.closed, e.impulses.iter().map(|i| format!("{:.3} {:.3}", i.1[0], i.1[2])).collect::<Vec<_>>(), e.fell_back); }
                    for p in &planned.phases { println!("plan {:?} {:.4}", p.closed, p.duration_s);
                      for (i, t) in p.times_s.iter().enumerate() { println!("    {:.4} q {} tau {} f {}", t, text(&p.q[i]), text(&p.torques_nm[i]), text(&(0..4).map(|c| p.forces_n[i][3*c+2]).collect::<Vec<_>>())); } }
                    state.t_s += 0.0;
                    section = super::section::Section::new(plant.as_mut(), &planned, &gains).unwrap();
                }
                let after = section.map(&zz).unwrap();
                let err = after.map(|a| a.iter().zip(&zz).map(|(a, b)| a - b).collect::<Vec<_>>());
                println!("k {k} {z:?} one step {:?} error {:?}", t0.elapsed(), err.map(|e| text(&e)));
                let cycle = section.cycle(3).unwrap();
                if let Some(c) = &cycle {
                    println!("   cycle residual {:.1e} multipliers {:?} {:?}", c.residual, &c.multipliers[..4], t0.elapsed());
                }
                let start = cycle.map_or(state, |c| c.start);
                let t0 = std::time::Instant::now();
                let walk = super::following::walk(plant.as_mut(), &planned, &gains, &start, 20).unwrap();
                let mut since: f64 = 0.0;
                for p in &planned.phases { print!(" plan {:.4} {:?};", since, p.closed); since += p.duration_s; }
                println!();
                if env("EV", 0.0) == 1.0 { for e in walk.run.events.iter().take(12) { println!("    {:.4} {:?} {:?} {:?} {}", e.t_s - planned.period_s * (e.t_s / planned.period_s).floor(), e.kind, e.closed, e.impulses.iter().map(|i| format!("{:.3} {:.3}", i.1[0], i.1[2])).collect::<Vec<_>>(), e.fell_back); } }
                println!("   walked {} {:?} speed {} cot {} tau2 {} max {} in {:?}", walk.steps, walk.run.stop, walk.speed_m_s, walk.cost_of_transport, walk.torque_squared, walk.torque_nm, t0.elapsed());
            }
        }
    }
    fn text(v: &[f64]) -> String {
        v.iter().map(|x| format!("{x:7.3}")).collect::<Vec<_>>().join(" ")
    }
}
