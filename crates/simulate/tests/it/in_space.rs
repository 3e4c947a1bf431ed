//! Rigid bodies in space on contact points, and what they do under dry friction.

use super::assert_near;
use denavit_codegen::model;
use denavit_plants::LoadedPlant;
use denavit_simulate::contact::Friction;
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::time_stepping::{StepSolver, Stepping, simulate_by_steps};
use denavit_simulate::{Control, Simulation, State, Stop, Tolerances, simulate};

/// A rigid body; its coordinates are z, x, y, yaw, roll and pitch.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) mass: f64,
    pub(super) center: [f64; 3],
    /// About the center of mass.
    pub(super) inertia: [f64; 3],
    pub(super) contacts: Vec<[f64; 3]>,
    pub(super) gravity: [f64; 3],
}

impl Body {
    /// A homogeneous block of these half edges: its lower four corners, or all eight.
    pub(super) fn block(half: [f64; 3], corners: usize) -> Self {
        let mass = 2.0;
        let [x, y, z] = half.map(|half| half * half);
        let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let layer = |z: f64| signs.map(|[x, y]| [x * half[0], y * half[1], z]);
        let layers = [layer(-half[2]), layer(half[2])];
        Self {
            mass,
            center: [0.0; 3],
            inertia: [y + z, x + z, x + y].map(|sum| mass * sum / 3.0),
            contacts: layers.into_iter().flatten().take(corners).collect(),
            gravity: [0.0, 0.0, -9.81],
        }
    }

    /// With gravity as on a slope of this tangent, which falls along x.
    pub(super) fn on_slope(mut self, tangent: f64) -> Self {
        let size = 9.81 / 1.0_f64.hypot(tangent);
        self.gravity = [size * tangent, 0.0, -size];
        self
    }

    pub(super) fn plant(&self) -> LoadedPlant {
        let contacts: Vec<_> = (0..self.contacts.len())
            .map(|index| {
                serde_json::json!({"name": format!("p{index}"), "link": "base_pitch",
                    "position": self.contacts[index]})
            })
            .collect();
        let [xx, yy, zz] = self.inertia;
        let file = serde_json::json!({
            "format": "denavit-model/1",
            "name": "body",
            "convention": "standard",
            "gravity": self.gravity,
            "base": {"type": "floating", "body": {"mass": self.mass, "com": self.center,
                "inertia": {"xx": xx, "yy": yy, "zz": zz}, "about": "com"}},
            "links": [{"name": "tail", "parent": "base", "joint": {"type": "fixed"}}],
            "contacts": contacts,
            "ground": {"point": [0, 0, 0], "normal": [0, 0, 1]},
        });
        let robot = model::read("body", file.to_string().as_bytes()).unwrap();
        LoadedPlant::new(&robot, &[]).unwrap()
    }
}

/// Three corners of a block that is not homogeneous.
pub(super) fn tetrahedral() -> Body {
    Body {
        inertia: [0.05, 0.06, 0.07],
        contacts: vec![[0.2, 0.1, -0.05], [-0.2, -0.1, -0.05], [-0.2, 0.1, -0.05]],
        ..Body::block([0.2, 0.1, 0.05], 0)
    }
}

/// A block is thrown across a slope on which friction is just as steep. What gravity gives it along
/// the slope friction takes: with phi the angle of its velocity from the fall line,
/// v (1 + cos phi) stays, and with g' = g sin of the slope d phi / dt = -g' sin phi / v.
///
/// With u = tan(phi / 2), v = v0 (1 + u^2) / 2 for phi0 = 90 degrees, du/dt = -g' u / v, so that
/// t = v0 / (2 g') (ln(1 / u) + (1 - u^2) / 2).
#[test]
fn a_block_thrown_across_a_slope_turns_down_it() {
    let tangent = 0.3;
    for speed in [1.0, 1e-2, 1e-3] {
        let body = Body::block([0.2, 0.1, 1e-9], 4).on_slope(tangent);
        let pull = body.gravity[0];
        let u = 0.2_f64;
        let time = speed / (2.0 * pull) * (-u.ln() + 0.5 * (1.0 - u * u));
        let mut simulation = Simulation {
            end_s: time,
            friction: Friction::Coulomb(tangent),
            log_period_s: time / 20.0,
            method: Method::DormandPrince(Accuracy {
                relative: 1e-11,
                absolute: 1e-12,
                max_step_s: 0.02,
            }),
            ..Simulation::default()
        };
        let mut state = State::resting(vec![1e-9, 0.0, 0.0, 0.0, 0.0, 0.0]);
        state.qd[2] = speed;
        simulation.touching.rest_speed = 1e-9;
        let run = simulate(&mut body.plant(), &Control::passive(6), &state, &simulation).unwrap();
        assert_eq!(run.stop, Stop::End);
        let broken = run.audit.broken(&Tolerances::default());
        assert!(broken.is_empty(), "{broken:?}");
        assert!(run.audit.friction_angle_rad < 1e-8, "{:e}", run.audit.friction_angle_rad);
        let (down, across) = (run.end.qd[1], run.end.qd[2]);
        let size = down.hypot(across);
        assert_near((size + down) / speed, 1.0, 1e-8);
        assert_near(size / speed, 0.5 * (1.0 + u * u), 1e-8);
    }
}

/// A block whose center of mass is beyond its edge tips about that edge from the start, in whatever
/// order its corners are listed: about the edge it has J = I + m (X^2 + Z^2), and at rest the
/// acceleration m g X / J, of which the edge feels m (g - X^2 m g / J).
#[test]
fn a_block_tips_over_its_edge_whatever_the_order_of_its_corners() {
    let overhang = 0.02;
    for order in [[0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1], [1, 3, 0, 2], [0, 2, 1, 3]] {
        let mut body = Body::block([0.2, 0.1, 0.05], 4);
        body.center = [0.2 + overhang, 0.0, 0.05];
        let corners = body.contacts.clone();
        body.contacts = order.map(|corner: usize| corners[corner]).to_vec();
        let mut simulation = Simulation { end_s: 0.05, ..Simulation::default() };
        simulation.friction = Friction::Coulomb(0.5);
        let start = State::resting(vec![0.05, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let run = simulate(&mut body.plant(), &Control::passive(6), &start, &simulation).unwrap();
        assert_eq!(run.stop, Stop::End);
        let broken = run.audit.broken(&Tolerances::default());
        assert!(broken.is_empty(), "{order:?}: {broken:?}");
        let (mass, height) = (body.mass, 0.1);
        let arm = mass * (overhang * overhang + height * height);
        let turning = mass * 9.81 * overhang / (body.inertia[1] + arm);
        let first = run.log.rows().next().unwrap();
        let normal: f64 =
            (0..4).map(|corner| run.log.column(&format!("f_p{corner}_z")).unwrap()[0]).sum();
        assert_near(normal, mass * (9.81 - turning * overhang), 1e-9);
        assert_eq!(first[0], 0.0);
    }
}

/// Nine points of a plate share its weight alike as it slides and turns: the way it stops does not
/// depend on their order, and is that of the equations of a plate whose points each carry a ninth.
#[test]
fn nine_sliding_points_are_shared_whatever_their_order() {
    let points: Vec<[f64; 3]> = (0..9)
        .map(|index| [0.2 * (f64::from(index / 3) - 1.0), 0.1 * (f64::from(index % 3) - 1.0), 0.0])
        .collect();
    let (mass, inertia, friction, end) = (3.0, 0.2, 0.35, 0.3);
    // classical Runge-Kutta of x, y, yaw and their rates
    let rates = |s: [f64; 6]| -> [f64; 6] {
        let (sine, cosine) = s[2].sin_cos();
        let mut pull = [0.0; 3];
        for [px, py, _] in &points {
            let arm = [cosine * px - sine * py, sine * px + cosine * py];
            let v = [s[3] - s[5] * arm[1], s[4] + s[5] * arm[0]];
            let size = v[0].hypot(v[1]);
            let f = [0, 1].map(|axis| -friction * mass * 9.81 / 9.0 * v[axis] / size);
            pull[0] += f[0] / mass;
            pull[1] += f[1] / mass;
            pull[2] += (arm[0] * f[1] - arm[1] * f[0]) / inertia;
        }
        [s[3], s[4], s[5], pull[0], pull[1], pull[2]]
    };
    let mut exact = [0.0, 0.0, 0.0, 1.0, 0.5, 5.0];
    let h = end / 20_000.0;
    for _ in 0..20_000 {
        let at = |k: [f64; 6], part: f64| std::array::from_fn(|i| exact[i] + part * h * k[i]);
        let a = rates(exact);
        let b = rates(at(a, 0.5));
        let c = rates(at(b, 0.5));
        let d = rates(at(c, 1.0));
        exact = std::array::from_fn(|i| exact[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
    }
    let mut simulation = Simulation { end_s: end, ..Simulation::default() };
    simulation.friction = Friction::Coulomb(friction);
    let mut start = State::resting(vec![0.0; 6]);
    start.qd = vec![0.0, 1.0, 0.5, 5.0, 0.0, 0.0];
    for order in
        [[0, 1, 2, 3, 4, 5, 6, 7, 8], [8, 7, 6, 5, 4, 3, 2, 1, 0], [4, 0, 7, 2, 8, 5, 1, 3, 6]]
    {
        let mut body = Body::block([0.2, 0.1, 0.0], 0);
        (body.mass, body.inertia) = (mass, [0.1, 0.1, inertia]);
        body.contacts = order.map(|point: usize| points[point]).to_vec();
        let control = Control::passive(6);
        let run = simulate(&mut body.plant(), &control, &start, &simulation).unwrap();
        assert_near(run.end.q[3], exact[2], 1e-6);
        for (solver, tolerance) in
            [(StepSolver::default(), 5e-3), (StepSolver::Pivots { facets: 32 }, 3e-2)]
        {
            let stepping = Stepping { solver, ..Stepping::default() };
            let mut plant = body.plant();
            let run = simulate_by_steps(&mut plant, &control, &start, &simulation, &stepping);
            let run = run.unwrap();
            assert_eq!(run.stop, Stop::End);
            println!("{order:?} {solver:?}: {} for {}", run.end.q[3], exact[2]);
            assert_near(run.end.q[3], exact[2], tolerance);
        }
    }
}
