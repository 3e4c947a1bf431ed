//! Sweeps and pivots make the same steps.

use super::systems::{GRAVITY, PlaneBody, run, stepping};
use denavit_simulate::contact::gauss_seidel::SweepLimits;
use denavit_simulate::time_stepping::{Scheme, StepSolver, Stepping};

#[test]
fn sweeps_and_pivots_agree_on_a_rocking_block() {
    for scheme in [Scheme::MoreauMidpoint, Scheme::Anitescu { reach_m: 0.05 }] {
        let solve = |solver| {
            let points = vec![[-0.1, -0.4], [0.1, -0.4]];
            let force = [0.0, -GRAVITY];
            let mut block = PlaneBody { mass: 1.0, inertia: 0.17 / 3.0, points, force };
            let (steps, laws) = stepping(scheme, 1e-3, 2, 0.6, 0.0);
            let laws = (Stepping { solver, ..steps }, laws);
            let z = 0.1 * 0.1_f64.sin() + 0.4 * 0.1_f64.cos();
            run(&mut block, laws, &[0.0, z, -0.1], &[0.0; 3], 1.5)
        };
        let limits = SweepLimits { sweeps: 100_000, response: 1e-14 };
        let swept = solve(StepSolver::Sweeps(limits));
        let pivoted = solve(StepSolver::Pivots { facets: 4 });
        for (a, b) in swept.iter().zip(&pivoted) {
            assert!(!a.report.fell_back, "the sweeps converge");
            for (a, b) in a.qd.iter().chain(&a.q).zip(b.qd.iter().chain(&b.q)) {
                assert!((a - b).abs() < 1e-8, "{a} {b}");
            }
        }
    }
}

/// Without sweeps, every step on whose contacts something slips is made by pivots, and says so.
#[test]
fn pivots_stand_in_for_sweeps() {
    let points = vec![[-0.1, -0.05], [0.1, -0.05]];
    let mut block = PlaneBody { mass: 1.0, inertia: 0.1, points, force: [4.0, -GRAVITY] };
    let solver = StepSolver::Sweeps(SweepLimits { sweeps: 0, response: 0.0 });
    let (steps, laws) = stepping(Scheme::MoreauMidpoint, 1e-3, 2, 0.3, 0.0);
    let laws = (Stepping { solver, ..steps }, laws);
    let samples = run(&mut block, laws, &[0.0, 0.05, 0.0], &[0.0; 3], 0.1);
    assert!(samples.iter().all(|sample| sample.report.fell_back));
    // It slips: 4 N is more than 0.3 times its weight.
    let end = samples.last().unwrap();
    assert!((end.qd[0] - 0.1 * (4.0 - 0.3 * GRAVITY)).abs() < 1e-12, "{:?}", end.qd);
}
