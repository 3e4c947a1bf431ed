//! Which contacts hold, slip and open, and with what forces.

use super::systems::{GRAVITY, System, assert_close, body, corners, number, plane_body, resting};
use denavit_simulate::contact::gauss_seidel::{self, SweepLimits};
use denavit_simulate::contact::lemke::LcpOutcome;
use denavit_simulate::contact::pyramid::Pyramid;
use denavit_simulate::contact::solver::{ContactSolver, Search};
use denavit_simulate::contact::{Contact, ContactFailure, ContactSolution, Friction, Mode, Space};
use proptest::prelude::*;

const NO_SLIP: Friction = Friction::NoSlip;

fn decide(
    system: &System,
    contacts: &[Contact],
    free: &[f64],
    search: Search,
) -> Result<ContactSolution, ContactFailure> {
    let mut solution = ContactSolution::default();
    ContactSolver::new().decide(&system.problem(contacts, free), search, &mut solution)?;
    Ok(solution)
}

/// A foot of 2 kg with the load at (x, y) of its sole: forces and moments about its centre.
fn loaded_foot(load: [f64; 2]) -> (System, Vec<f64>) {
    let (mass, inertia) = (2.0, [0.01, 0.02, 0.03]);
    let foot = body(mass, inertia, &corners(0.1, 0.05, 0.04));
    // Gravity, and the moment that moves the centre of pressure.
    let moment = [-mass * GRAVITY * load[1], mass * GRAVITY * load[0], 0.0];
    let v = [0.0, 0.0, -GRAVITY, moment[0] / inertia[0], moment[1] / inertia[1], 0.0];
    let free = foot.contact_velocity(&v);
    (foot, free)
}

#[test]
fn a_flat_foot_carries_its_weight_with_the_least_forces() {
    let (foot, free) = loaded_foot([0.0, 0.0]);
    let found = decide(&foot, &resting(4, NO_SLIP), &free, Search::All).unwrap();
    assert_eq!(found.modes, [Mode::Stick; 4]);
    assert_eq!(found.redundancy, 6);
    let quarter = 2.0 * GRAVITY / 4.0;
    for corner in 0..4 {
        assert_close(&found.force[3 * corner..][..3], &[0.0, 0.0, quarter], 1e-10);
    }
    assert_close(&found.response, &[0.0; 12], 1e-10);
}

#[test]
fn a_foot_holds_until_its_load_leaves_the_sole() {
    // The least forces of all would pull at a corner from |x|/a + |y|/b > 1 on.
    for (load, holds) in [([0.08, 0.03], true), ([0.099, 0.049], true), ([0.101, 0.0], false)] {
        let (foot, free) = loaded_foot(load);
        let found = decide(&foot, &resting(4, NO_SLIP), &free, Search::First).unwrap();
        assert_eq!(found.modes == [Mode::Stick; 4], holds, "load at {load:?}");
        let normals: Vec<f64> = found.force.chunks(3).map(|f| f[2]).collect();
        assert!(normals.iter().all(|f| *f >= -1e-9), "{normals:?}");
        if holds {
            let total: f64 = normals.iter().sum();
            let x = 0.1 * (normals[0] + normals[1] - normals[2] - normals[3]);
            let y = 0.05 * (normals[0] - normals[1] + normals[2] - normals[3]);
            assert_close(&[total, x / total, y / total], &[2.0 * GRAVITY, load[0], load[1]], 1e-9);
        } else {
            assert!(!found.modes[2].is_closed() && !found.modes[3].is_closed());
            assert!(found.response[8] > 0.0 && found.response[11] > 0.0);
        }
    }
}

/// The margin is the largest smallest force: for a load at x on a sole of half length a the rear
/// pair carries (a - x) / 2a of the weight, half each.
#[test]
fn the_margin_is_the_force_of_the_least_loaded_corner() {
    let mut solver = ContactSolver::new();
    for x in [0.0, 0.05, 0.0999, 0.1001, 0.12] {
        let (foot, free) = loaded_foot([x, 0.0]);
        let contacts = resting(4, NO_SLIP);
        let problem = foot.problem(&contacts, &free);
        let (margin, _) = solver.margin(&problem, &[Mode::Stick; 4]).unwrap();
        let expected = 2.0 * GRAVITY * (0.1 - x) / 0.4;
        assert_close(&[margin], &[expected], 1e-9);
    }
    // Off both axes the least forces would pull at the far corner; the best distribution does not.
    let (foot, free) = loaded_foot([0.08, 0.03]);
    let contacts = resting(4, NO_SLIP);
    let (margin, _) = solver.margin(&foot.problem(&contacts, &free), &[Mode::Stick; 4]).unwrap();
    assert!(margin > 0.1, "{margin}");
}

#[test]
fn a_block_on_a_slope_sticks_below_the_angle_of_friction_and_slips_above() {
    let slope = 0.2_f64;
    let block = plane_body(1.5, 0.02, &[[-0.1, -0.05], [0.1, -0.05]]);
    let pull = [GRAVITY * slope.sin(), -GRAVITY * slope.cos(), 0.0];
    let free = block.contact_velocity(&pull);
    for mu in [0.1, 0.3] {
        let contacts = resting(2, Friction::Coulomb(mu));
        let found = decide(&block, &contacts, &free, Search::All).unwrap();
        let (tangential, normal) =
            (found.force[0] + found.force[2], found.force[1] + found.force[3]);
        assert_close(&[normal], &[1.5 * GRAVITY * slope.cos()], 1e-10);
        if mu > slope.tan() {
            assert_eq!(found.modes, [Mode::Stick; 2]);
            assert_close(&[tangential], &[-1.5 * GRAVITY * slope.sin()], 1e-10);
        } else {
            assert_eq!(found.modes, [Mode::Slip([1.0, 0.0]); 2]);
            let acceleration = GRAVITY * (slope.sin() - mu * slope.cos());
            assert_close(&[found.response[0]], &[acceleration], 1e-10);
        }
    }
}

/// walking.md 1.5: a rod that slides on its end, tilted by 0.5; inconsistent from mu = 2.62275 on.
#[test]
fn painleve_is_detected() {
    let (angle, length, mass) = (0.5_f64, 1.0, 1.0);
    let (c, s) = (0.5 * length * angle.cos(), 0.5 * length * angle.sin());
    let rod = plane_body(mass, mass * length * length / 12.0, &[[-c, -s]]);
    let sliding = |mu, direction: f64| {
        let slipping = Some([direction, 0.0]);
        [Contact { slipping, ..Contact::resting(Friction::Coulomb(mu)) }]
    };
    let falling = rod.contact_velocity(&[0.0, -GRAVITY, 0.0]);
    let critical = 2.622_751_125_6;
    for (mu, expected) in
        [(critical - 1e-6, None), (critical + 1e-6, Some(ContactFailure::NoSolution))]
    {
        // The end slides so that friction presses it into the ground: one of both directions.
        let found = [1.0, -1.0]
            .map(|direction| decide(&rod, &sliding(mu, direction), &falling, Search::All).err());
        assert!(found.contains(&expected), "mu = {mu}: {found:?}");
        assert_eq!(
            found.iter().filter(|failure| failure.is_some()).count(),
            usize::from(expected.is_some())
        );
    }
    // Lifted by its own rotation, the same contact may open or jam: two motions.
    let rising = [0.0, 1.0];
    let found = [1.0, -1.0].map(|direction| {
        decide(&rod, &sliding(critical + 0.1, direction), &rising, Search::All).err()
    });
    assert!(found.contains(&Some(ContactFailure::SeveralSolutions)), "{found:?}");
}

#[test]
fn slipping_in_space_opposes_the_motion_that_it_leaves() {
    // A point mass beside a flat foot: pushed at an angle, and a foot that is also twisted.
    for (push, twist) in [([3.0, 4.0], 0.0), ([3.0, 4.0], 40.0), ([0.5, 0.2], -60.0)] {
        let foot = body(2.0, [0.01, 0.02, 0.03], &corners(0.1, 0.05, 0.04));
        let v = [push[0], push[1], -GRAVITY, 0.0, 0.0, twist];
        let free = foot.contact_velocity(&v);
        let contacts = resting(4, Friction::Coulomb(0.2));
        let found = decide(&foot, &contacts, &free, Search::First).unwrap();
        let total: f64 = found.force.chunks(3).map(|f| f[2]).sum();
        assert_close(&[total], &[2.0 * GRAVITY], 1e-9);
        for (f, w) in found.force.chunks(3).zip(found.response.chunks(3)) {
            let speed = w[0].hypot(w[1]);
            assert!(speed > 1e-3, "it slips");
            let expected = [-0.2 * f[2] * w[0] / speed, -0.2 * f[2] * w[1] / speed];
            assert_close(&f[..2], &expected, 1e-9);
        }
    }
}

#[test]
fn a_cone_is_not_its_pyramid_but_its_limit() {
    // Pushed along 22.5 degrees, between the edges of a pyramid of 8 and on one of 16.
    let foot = body(2.0, [0.01, 0.02, 0.03], &corners(0.1, 0.05, 0.0));
    let angle = std::f64::consts::PI / 8.0;
    let v = [3.0 * angle.cos(), 3.0 * angle.sin(), -GRAVITY, 0.0, 0.0, 0.0];
    let free = foot.contact_velocity(&v);
    let contacts = resting(4, Friction::Coulomb(0.2));
    let problem = foot.problem(&contacts, &free);
    let braking = |force: &[f64]| {
        let along = |f: &[f64]| -(f[0] * angle.cos() + f[1] * angle.sin());
        force.chunks(3).map(along).sum::<f64>()
    };
    let full = 0.2 * 2.0 * GRAVITY;
    for (facets, expected) in [(8, full * angle.cos()), (16, full)] {
        let mut force = vec![0.0; 12];
        let report = Pyramid::new().solve(&problem, facets, &mut force);
        assert_eq!(report.outcome, LcpOutcome::Solved);
        assert_close(&[braking(&force)], &[expected], 1e-9);
    }
    let mut force = vec![0.0; 12];
    let limits = SweepLimits { sweeps: 10_000, response: 1e-13 };
    assert!(gauss_seidel::solve(&problem, limits, &mut force).converged);
    assert_close(&[braking(&force)], &[full], 1e-9);
}

#[test]
fn impossible_numbers_and_too_many_contacts_are_refused() {
    let (foot, mut free) = loaded_foot([0.0, 0.0]);
    free[2] = f64::NAN;
    let found = decide(&foot, &resting(4, NO_SLIP), &free, Search::First);
    assert_eq!(found.unwrap_err(), ContactFailure::NotFinite);
    let points: Vec<[f64; 2]> = (0..20).map(|k| [0.1 * f64::from(k), 0.0]).collect();
    let beam = plane_body(1.0, 1.0, &points);
    let free = beam.contact_velocity(&[0.0, -GRAVITY, 0.0]);
    let found = decide(&beam, &resting(20, NO_SLIP), &free, Search::First);
    assert_eq!(found.unwrap_err(), ContactFailure::TooManyModes { contacts: 20 });
}

#[test]
fn a_released_contact_carries_nothing() {
    let (foot, free) = loaded_foot([0.101, 0.0]);
    let mut contacts = resting(4, NO_SLIP);
    contacts[2].released = true;
    let found = decide(&foot, &contacts, &free, Search::First).unwrap();
    assert!(!found.modes[2].is_closed());
    assert_close(&found.force[6..9], &[0.0; 3], 0.0);
}

proptest! {
    /// Sweeps, the pyramid's pivots (exact in a plane) and the enumeration are three solvers.
    #[test]
    fn three_solvers_agree_in_the_plane(
        count in 1_usize..=4, seed in 0_u64..1_000_000, mu in 0.05_f64..0.4,
    ) {
        let dof = 9;
        let entry = |key: usize| number(seed, key as u64);
        let jacobian: Vec<f64> = (0..2 * count * dof).map(entry).collect();
        let mass = super::systems::diagonal(&vec![1.0; dof]);
        let system = System::new(Space::Planar, mass, jacobian);
        let free: Vec<f64> = (0..2 * count).map(|k| entry(5000 + k)).collect();
        let contacts = resting(count, Friction::Coulomb(mu));
        let problem = system.problem(&contacts, &free);
        let (mut swept, mut pivoted) = (vec![0.0; 2 * count], vec![0.0; 2 * count]);
        let report = Pyramid::new().solve(&problem, 2, &mut pivoted);
        prop_assert_eq!(report.outcome, LcpOutcome::Solved);
        let limits = SweepLimits { sweeps: 100_000, response: 1e-14 };
        // Sweeps need not converge for every matrix, and solutions need not be unique; where they
        // are, all agree.
        prop_assume!(gauss_seidel::solve(&problem, limits, &mut swept).converged);
        match decide(&system, &contacts, &free, Search::All) {
            Ok(found) => {
                let size = found.force.iter().fold(1.0_f64, |sum, f| sum.max(f.abs()));
                for other in [&swept, &pivoted] {
                    let mut response = vec![0.0; 2 * count];
                    problem.respond(other, &mut response);
                    for (a, b) in response.iter().zip(&found.response) {
                        prop_assert!((a - b).abs() < 1e-7 * size, "{a} {b}");
                    }
                }
            }
            Err(failure) => prop_assert_eq!(failure, ContactFailure::SeveralSolutions),
        }
    }
}
