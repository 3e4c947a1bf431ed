//! The kneed walker of Hsu 2007 on its limit cycle, against the same model solved elsewhere.

use super::assert_near;
use denavit_plants::KneedWalker;
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::{Control, EventKind, Simulation, State, simulate};

#[test]
fn the_kneed_walker_walks_on_its_limit_cycle() {
    let (legs, rates) = ([0.18927347963, -0.29001051344], [-1.13381658645, -0.10872933848]);
    let (knee_s, period) = (0.36355185526, 0.54584614270);
    let slope = (7.25_f64 / 144.0).asin();
    let mut walker = KneedWalker::new(slope);
    assert_near(legs[0] + legs[1], -2.0 * slope, 1e-10);
    let initial =
        State { qd: vec![rates[0], rates[1], 0.0], ..State::resting(vec![legs[0], legs[1], 0.0]) };
    let accuracy = Accuracy { relative: 1e-12, absolute: 1e-13, max_step_s: 0.02 };
    let simulation = Simulation {
        end_s: 3.5 * period,
        method: Method::DormandPrince(accuracy),
        ..Simulation::default()
    };
    let run = simulate(&mut walker, &Control::passive(3), &initial, &simulation).unwrap();
    let strikes: Vec<_> = run.events.chunks(2).collect();
    assert_eq!(run.events.len(), 6, "{:?}", run.events);
    for (step, events) in strikes.iter().enumerate() {
        let start = step as f64 * period;
        assert_eq!(events[0].kind, EventKind::Jump(KneedWalker::KNEE_STRIKE));
        assert_near(events[0].t_s, start + knee_s, 1e-9);
        let heel = &events[1];
        assert_eq!(heel.kind, EventKind::Jump(KneedWalker::HEEL_STRIKE));
        assert_near(heel.t_s, start + period, 1e-9);
        for leg in 0..2 {
            assert_near(heel.q[leg], legs[leg], 1e-9);
            assert_near(heel.after[leg], rates[leg], 1e-9);
        }
    }
}
