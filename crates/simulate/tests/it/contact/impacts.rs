//! Impacts against the closed forms of walking.md 1.5 and a scuff that has no no-slip solution.

use super::systems::{System, assert_close, body, corners, diagonal, number, plane_body, resting};
use denavit_simulate::contact::impact::{Impact, ImpactReport, ImpactSolver};
use denavit_simulate::contact::solver::Search;
use denavit_simulate::contact::{
    ContactFailure, ContactSolution, Friction, Mode, Space, Tolerance,
};
use proptest::prelude::*;

fn collide(
    system: &System,
    friction: Friction,
    e: f64,
    v: &[f64],
) -> Result<(Vec<f64>, ContactSolution, ImpactReport), ContactFailure> {
    let count = system.jacobian.len() / system.dof / system.space.rows();
    let impact = Impact {
        space: system.space,
        contacts: &resting(count, friction),
        restitution: &vec![e; count],
        delassus: system.delassus.matrix(),
        before: &system.contact_velocity(v),
        tolerance: Tolerance::default(),
    };
    let mut solution = ContactSolution::default();
    let report = ImpactSolver::new().solve(&impact, Search::First, &mut solution)?;
    let after = system.after(v, &solution.force);
    let change = system.kinetic_energy(&after) - system.kinetic_energy(v);
    let size = solution.force.iter().fold(1.0_f64, |sum, p| sum.max(p.abs()));
    assert_close(&[report.energy_j], &[change], 1e-10 * size);
    assert_close(&solution.response, &system.contact_velocity(&after), 1e-10 * size);
    Ok((after, solution, report))
}

/// A block 2b x 2h falls back onto its second corner: omega+ = (1 - 3/2 sin^2 alpha) omega-.
#[test]
fn a_rocking_block_opens_its_old_corner() {
    let (b, h, omega) = (0.1, 0.4, -0.831_368_076_70);
    let block = plane_body(1.0, (b * b + h * h) / 3.0, &[[-b, -h], [b, -h]]);
    // It turns about the left corner, clockwise: that corner is at rest.
    let v = [-h * omega, b * omega, omega];
    assert_close(&block.contact_velocity(&v)[..2], &[0.0; 2], 1e-15);
    let (after, solution, _) = collide(&block, Friction::NoSlip, 0.0, &v).unwrap();
    assert_close(&[after[2] / omega], &[0.911_764_705_882_353], 1e-12);
    assert_eq!(solution.modes, [Mode::Open, Mode::Stick]);
}

#[test]
fn a_falling_rod_with_and_without_friction() {
    let angle = 0.5_f64;
    let (c, s) = (0.5 * angle.cos(), 0.5 * angle.sin());
    let rod = plane_body(1.0, 1.0 / 12.0, &[[-c, -s]]);
    let v = [0.0, -1.0, 0.0];
    let (after, smooth, _) = collide(&rod, Friction::Coulomb(0.0), 0.0, &v).unwrap();
    assert_close(&smooth.force, &[0.0, 0.302_073_420_59], 1e-10);
    assert_close(&[after[2].abs()], &[1.590_566_197_92], 1e-10);
    let (after, rough, report) = collide(&rod, Friction::NoSlip, 0.0, &v).unwrap();
    assert_close(&[rough.force[0].abs(), rough.force[1]], &[0.315_551_62, 0.422_386_64], 1e-8);
    let omega = 1.316_373_842_84_f64;
    // What is left is rotation about the end: m L^2 / 3.
    let lost = omega * omega / 6.0 - 0.5;
    assert_close(&[after[2].abs(), report.energy_j], &[omega, lost], 1e-10);
    // It needs a friction of 0.7470681904.
    for (mu, mode) in [(0.74706, false), (0.74707, true)] {
        let (_, found, _) = collide(&rod, Friction::Coulomb(mu), 0.0, &v).unwrap();
        assert_eq!(found.modes[0] == Mode::Stick, mode, "mu = {mu}: {:?}", found.modes);
    }
}

/// Equal balls in a row touch; the first comes with speed 1. All at once, Newton's law.
fn cradle(balls: usize) -> System {
    let mut rows = Vec::new();
    for gap in 0..balls - 1 {
        // The tangential row of balls that only move along their line is empty.
        rows.extend(vec![0.0; balls]);
        rows.extend(
            (0..balls).map(|ball| {
                f64::from(u8::from(ball == gap + 1)) - f64::from(u8::from(ball == gap))
            }),
        );
    }
    System::new(Space::Planar, diagonal(&vec![1.0; balls]), rows)
}

#[test]
fn cradles_of_newton() {
    let third = 1.0 / 3.0;
    let first = |balls: usize| {
        let mut v = vec![0.0; balls];
        v[0] = 1.0;
        v
    };
    let smooth = Friction::Coulomb(0.0);
    let (after, found, report) = collide(&cradle(3), smooth, 1.0, &first(3)).unwrap();
    assert_close(&after, &[-third, 2.0 * third, 2.0 * third], 1e-14);
    assert_close(&[found.force[1], found.force[3]], &[4.0 * third, 2.0 * third], 1e-14);
    assert_close(&[report.energy_j, report.restitution_factor], &[0.0, 1.0], 1e-14);
    let (after, ..) = collide(&cradle(5), smooth, 1.0, &first(5)).unwrap();
    assert_close(&after, &[-0.6, 0.4, 0.4, 0.4, 0.4], 1e-14);
    let (after, ..) = collide(&cradle(5), smooth, 0.0, &first(5)).unwrap();
    assert_close(&after, &[0.2; 5], 1e-14);
}

/// A swing foot scuffs while the other stands: stance heel and toe, swing heel (x, z each). All
/// eight subsets of closed contacts violate a sign; with Coulomb friction there is a solution.
/// Numbers from the prototype of the planar biped.
#[test]
fn a_scuff_has_no_solution_without_slip() {
    // Order of the prototype: normals of the three, then tangentials.
    let g = [
        [2.939607574265242, -3.232278888577139, 0.03621352263248939],
        [-3.2322788885771407, 9.299633243133801, -0.007133387085372188],
        [0.03621352263248938, -0.007133387085372167, 2.7606884722590572],
        [-1.630390052891716, 1.7713273499984603, 0.003576170730295004],
        [-1.630390052891716, 1.7713273499984603, 0.003576170730295004],
        [0.0036228052686259203, -0.000812614592216085, -1.9622262129331147],
    ];
    let tangential = [
        [2.455803150451173, 2.455803150451173, 0.000489976465821062],
        [2.455803150451173, 2.455803150451173, 0.000489976465821062],
        [0.0004899764658210507, 0.0004899764658210507, 2.3955653142898017],
    ];
    let entry = |i: usize, j: usize| match (i / 3, j / 3) {
        (_, 0) => g[i][j],
        (0, _) => g[j][i],
        _ => tangential[i - 3][j - 3],
    };
    let place = |row: usize| if row % 2 == 1 { row / 2 } else { 3 + row / 2 };
    let delassus: Vec<f64> = (0..36).map(|k| entry(place(k / 6), place(k % 6))).collect();
    let before = [0.0, 0.0, 0.0, 0.0, 0.0472442040233317, -0.012466657158998551];
    let solve = |friction| {
        let impact = Impact {
            space: Space::Planar,
            contacts: &resting(3, friction),
            restitution: &[0.0; 3],
            delassus: &delassus,
            before: &before,
            tolerance: Tolerance::default(),
        };
        let mut solution = ContactSolution::default();
        ImpactSolver::new().solve(&impact, Search::All, &mut solution).map(|_| solution)
    };
    assert_eq!(solve(Friction::NoSlip).unwrap_err(), ContactFailure::NoSolution);
    let found = solve(Friction::Coulomb(0.8)).unwrap();
    let printed = [0.0, 0.0, -0.000_002, 0.000_002, -0.002_303, 0.002_879];
    assert_close(&found.force, &printed, 1e-6);
    let printed = [0.000_009, 0.000_091, 0.000_009, 0.0, 0.036_078, 0.0];
    assert_close(&found.response, &printed, 1e-6);
}

#[test]
fn a_flat_foot_lands_at_once() {
    let foot = body(2.0, [0.01, 0.02, 0.03], &corners(0.1, 0.05, 0.04));
    let v = [0.3, -0.1, -0.5, 0.0, 0.0, 0.2];
    let (after, found, _) = collide(&foot, Friction::NoSlip, 0.0, &v).unwrap();
    assert_close(&after, &[0.0; 6], 1e-12);
    assert_eq!((found.modes.len(), found.redundancy), (4, 6));
    let total: f64 = found.force.chunks(3).map(|p| p[2]).sum();
    assert_close(&[total], &[2.0 * 0.5], 1e-12);
}

proptest! {
    #[test]
    fn energy_never_increases(
        count in 1_usize..=3, seed in 0_u64..1_000_000, e in 0.0_f64..=1.0, mu in 0.0_f64..1.0,
        no_slip in any::<bool>(),
    ) {
        let entry = |key: usize| number(seed, key as u64);
        // Apart from each other, so that no force is arbitrarily large.
        let at = |k: usize| 0.5 * k as f64 - 0.5 + 0.1 * entry(k);
        let point = |k: usize| [at(k), -0.5 + 0.1 * entry(9 + k)];
        let points: Vec<[f64; 2]> = (0..count).map(point).collect();
        let system = plane_body(1.0, 0.05 + entry(30).abs(), &points);
        let v: Vec<f64> = (0..3).map(|k| entry(20 + k)).collect();
        let friction = if no_slip { Friction::NoSlip } else { Friction::Coulomb(mu) };
        match collide(&system, friction, e, &v) {
            Ok((_, found, report)) => {
                prop_assert!(report.energy_j <= 1e-9);
                for (p, u) in found.force.chunks(2).zip(found.response.chunks(2)) {
                    prop_assert!(p[1] >= -1e-8 && u[1] >= -1e-8);
                }
            }
            Err(failure) => prop_assert_eq!(failure, ContactFailure::NoSolution),
        }
    }
}
