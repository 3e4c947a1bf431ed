//! Laws of mechanics, exactly, at random points modulo 2^61 - 1, on every shipped robot. Each law
//! ties results of different recursions to each other, or to symbolic derivatives of energies.

use crate::robots::{fixture, load, shipped};
use denavit_codegen::derive::{Derivation, Flavour, derive};
use denavit_codegen::expr::{ExprId, Floats, Residues, derivative, evaluate, substitute};
use denavit_codegen::function::FunctionName::{self, *};
use denavit_codegen::model::{JointVariables, Robot};
use denavit_codegen::number::Residue;
use rustc_hash::FxHashMap;

pub(crate) const SEEDS: [u64; 2] = [1, 20_091_001];

/// A derived robot with what the laws need.
pub(crate) struct Derived {
    pub(crate) name: String,
    pub(crate) derivation: Derivation,
    pub(crate) joints: Vec<JointVariables>,
}

impl Derived {
    pub(crate) fn new(robot: &Robot, wanted: &[FunctionName]) -> Self {
        let derivation = derive(robot, Flavour::Tunable, wanted).unwrap();
        let joints = robot.joints().map(|(_, variables)| *variables).collect();
        Self { name: robot.name.clone(), derivation, joints }
    }

    /// Entries of one output of a function; of all outputs without a name.
    pub(crate) fn entries(&self, function: FunctionName, output: &str) -> Vec<ExprId> {
        let function = self.derivation.functions.iter().find(|made| made.name == function).unwrap();
        function.outputs.iter().find(|made| made.name == output).unwrap().entries.clone()
    }

    pub(crate) fn values(&self, entries: &[ExprId], seed: u64) -> Vec<Residue> {
        evaluate(&self.derivation.dag, entries, &mut Residues::new(seed)).unwrap()
    }

    pub(crate) fn symbols(&self, of: fn(&JointVariables) -> ExprId) -> Vec<ExprId> {
        self.joints.iter().map(of).collect()
    }

    /// Derivatives of `entries` by every symbol of `by`: `result[j][i]` is d entry_i / d by_j.
    pub(crate) fn gradient(&mut self, entries: &[ExprId], by: &[ExprId]) -> Vec<Vec<ExprId>> {
        let dag = &mut self.derivation.dag;
        by.iter()
            .map(|&symbol| {
                let seeds = FxHashMap::from_iter([(symbol, dag.one())]);
                derivative(dag, entries, &seeds)
            })
            .collect()
    }

    /// The derivative with respect to time: q moves at qd, qd at qdd.
    pub(crate) fn time_derivative(&mut self, entries: &[ExprId]) -> Vec<ExprId> {
        let seeds =
            self.joints.iter().flat_map(|joint| [(joint.q, joint.qd), (joint.qd, joint.qdd)]);
        derivative(&mut self.derivation.dag, entries, &seeds.collect())
    }
}

/// Every shipped robot, and one with nothing but skew axes.
pub(crate) fn robots() -> Vec<Robot> {
    let mut robots: Vec<Robot> = shipped().iter().map(|name| load(name)).collect();
    robots.push(fixture("general_6r.json"));
    robots
}

/// Runs `law` on every robot with the functions that it needs.
pub(crate) fn for_each_robot(wanted: &[FunctionName], law: impl Fn(&mut Derived)) {
    robots().iter().for_each(|robot| law(&mut Derived::new(robot, wanted)));
}

/// `A x` for a row-major square matrix.
pub(crate) fn apply(matrix: &[Residue], vector: &[Residue]) -> Vec<Residue> {
    matrix.chunks(vector.len()).map(|row| dot(row, vector)).collect()
}

pub(crate) fn dot(a: &[Residue], b: &[Residue]) -> Residue {
    a.iter().zip(b).fold(Residue::ZERO, |sum, (&x, &y)| sum + x * y)
}

pub(crate) fn add(a: &[Residue], b: &[Residue]) -> Vec<Residue> {
    a.iter().zip(b).map(|(&x, &y)| x + y).collect()
}

#[test]
fn inverse_dynamics_is_d_qdd_plus_bias() {
    for_each_robot(&[InverseDynamics, MassMatrix, Bias], |robot| {
        for seed in SEEDS {
            let qdd = robot.values(&robot.symbols(|joint| joint.qdd), seed);
            let d = robot.values(&robot.entries(MassMatrix, "mass_matrix"), seed);
            let bias = robot.values(&robot.entries(Bias, "bias"), seed);
            let tau = robot.values(&robot.entries(InverseDynamics, "tau"), seed);
            assert_eq!(tau, add(&apply(&d, &qdd), &bias), "{}", robot.name);
        }
    });
}

#[test]
fn bias_is_c_qd_plus_g_plus_the_joints_own_torques() {
    for_each_robot(&[Bias, CoriolisMatrix, GravityVector, DynamicsTerms], |robot| {
        // Friction, springs and offsets: what is left of the bias at rest without gravity is found
        // by taking the rigid part away, so it must not depend on other joints' variables.
        let own: Vec<ExprId> = robot.entries(Bias, "bias");
        for seed in SEEDS {
            let qd = robot.values(&robot.symbols(|joint| joint.qd), seed);
            let c = robot.values(&robot.entries(CoriolisMatrix, "coriolis_matrix"), seed);
            let g = robot.values(&robot.entries(GravityVector, "gravity_vector"), seed);
            let rigid = add(&apply(&c, &qd), &g);
            let bias = robot.values(&own, seed);
            let fused_c = robot.values(&robot.entries(DynamicsTerms, "coriolis_matrix"), seed);
            assert_eq!(c, fused_c, "{}: fused C", robot.name);
            let passive = robot.derivation.robot.links.values().all(|link| {
                link.drive.is_none() && link.joint.spring.is_none() && link.joint.damping.is_none()
            });
            if passive {
                assert_eq!(bias, rigid, "{}", robot.name);
            }
        }
    });
}

#[test]
fn forward_dynamics_inverts_inverse_dynamics() {
    for_each_robot(&[ForwardDynamics, MassMatrix, Bias, MassMatrixSolve], |robot| {
        for seed in SEEDS {
            let d = robot.values(&robot.entries(MassMatrix, "mass_matrix"), seed);
            let bias = robot.values(&robot.entries(Bias, "bias"), seed);
            let qdd = robot.values(&robot.entries(ForwardDynamics, "qdd"), seed);
            let tau = robot.values(&robot.symbols(|joint| joint.tau), seed);
            assert_eq!(add(&apply(&d, &qdd), &bias), tau, "{}", robot.name);
            let solve = robot.derivation.functions.iter().find(|f| f.name == MassMatrixSolve);
            let right = robot.values(&solve.unwrap().arguments[1].symbols.clone(), seed);
            let x = robot.values(&robot.entries(MassMatrixSolve, "x"), seed);
            assert_eq!(apply(&d, &x), right, "{}: D x = b", robot.name);
        }
    });
}

#[test]
fn d_is_the_hessian_of_the_kinetic_energy() {
    for_each_robot(&[MassMatrix, KineticEnergy], |robot| {
        let energy = robot.entries(KineticEnergy, "kinetic_energy");
        let rates = robot.symbols(|joint| joint.qd);
        let momenta: Vec<ExprId> = robot.gradient(&energy, &rates).concat();
        let hessian = robot.gradient(&momenta, &rates).concat();
        let d = robot.entries(MassMatrix, "mass_matrix");
        for seed in SEEDS {
            assert_eq!(robot.values(&d, seed), robot.values(&hessian, seed), "{}", robot.name);
        }
    });
}

#[test]
fn ddot_minus_2c_is_skew_and_c_is_christoffel() {
    for_each_robot(&[MassMatrix, CoriolisMatrix], |robot| {
        let n = robot.joints.len();
        let d = robot.entries(MassMatrix, "mass_matrix");
        let rate = robot.time_derivative(&d);
        let slopes = robot.gradient(&d, &robot.symbols(|joint| joint.q));
        let half = Residue::new(2).inverse().unwrap();
        for seed in SEEDS {
            let c = robot.values(&robot.entries(CoriolisMatrix, "coriolis_matrix"), seed);
            let rate = robot.values(&rate, seed);
            let qd = robot.values(&robot.symbols(|joint| joint.qd), seed);
            let slopes: Vec<_> = slopes.iter().map(|slope| robot.values(slope, seed)).collect();
            for i in 0..n {
                for j in 0..n {
                    let (ij, ji) = (i * n + j, j * n + i);
                    let skew = rate[ij] - c[ij] - c[ij] + rate[ji] - c[ji] - c[ji];
                    assert_eq!(skew, Residue::ZERO, "{}: skew {i} {j}", robot.name);
                    let christoffel = (0..n).fold(Residue::ZERO, |sum, k| {
                        let symbol = slopes[k][ij] + slopes[j][i * n + k] - slopes[i][j * n + k];
                        sum + half * symbol * qd[k]
                    });
                    assert_eq!(c[ij], christoffel, "{}: C {i} {j}", robot.name);
                }
            }
        }
    });
}

#[test]
fn g_is_the_gradient_of_the_potential_energy_of_gravity() {
    for_each_robot(&[GravityVector, PotentialEnergy, Bias], |robot| {
        let energy = robot.entries(PotentialEnergy, "potential_energy");
        let slope = robot.gradient(&energy, &robot.symbols(|joint| joint.q)).concat();
        let g = robot.entries(GravityVector, "gravity_vector");
        for seed in SEEDS {
            let (slope, g) = (robot.values(&slope, seed), robot.values(&g, seed));
            for (i, (link, _)) in robot.derivation.robot.joints().enumerate() {
                let link = &robot.derivation.robot.links[link];
                let has_spring = link.joint.spring.is_some()
                    || link.drive.is_some_and(|drive| drive.return_spring.is_some());
                if !has_spring {
                    assert_eq!(slope[i], g[i], "{}: joint {}", robot.name, link.name);
                }
            }
        }
    });
}

#[test]
fn power_of_the_torques_is_the_rate_of_the_energy() {
    // Without friction: tau . qd = d/dt (T + P), springs and rotors included. One-sided springs are
    // selections, opaque modulo p: they have a test of their own.
    for name in shipped() {
        let mut model = load(&name);
        model.terms.friction = false;
        for link in model.links.values_mut() {
            if let Some(drive) = &mut link.drive {
                drive.offset = None;
                drive.return_spring = None;
            }
        }
        let wanted = [InverseDynamics, KineticEnergy, PotentialEnergy];
        let mut robot = Derived::new(&model, &wanted);
        let kinetic = robot.entries(KineticEnergy, "kinetic_energy");
        let potential = robot.entries(PotentialEnergy, "potential_energy");
        let rates = robot.time_derivative(&[kinetic[0], potential[0]]);
        for seed in SEEDS {
            let tau = robot.values(&robot.entries(InverseDynamics, "tau"), seed);
            let qd = robot.values(&robot.symbols(|joint| joint.qd), seed);
            let rates = robot.values(&rates, seed);
            assert_eq!(dot(&tau, &qd), rates[0] + rates[1], "{name}");
        }
    }
}

#[test]
fn a_one_sided_spring_pushes_back_on_its_side_alone() {
    // TUlip's ankle: stiffness 5 N m/rad above -0.5 rad (models/tulip.json).
    let mut model = load("tulip");
    model.terms.friction = false;
    let mut robot = Derived::new(&model, &[Bias, GravityVector, PotentialEnergy]);
    let row = robot.joints.iter().position(|joint| {
        robot.derivation.dag.as_symbol(joint.q).unwrap().name == "q_right_ankle_y"
    });
    let row = row.unwrap();
    let energy = robot.entries(PotentialEnergy, "potential_energy");
    let slope = robot.gradient(&energy, &[robot.joints[row].q])[0][0];
    let spring = [
        robot.entries(Bias, "bias")[row],
        robot.entries(GravityVector, "gravity_vector")[row],
        slope,
    ];
    for (angle, torque) in [(-0.7, 0.0), (-0.3, 5.0 * 0.2), (0.4, 5.0 * 0.9)] {
        let mut point = Floats::new(|name| match name {
            "q_right_ankle_y" => Some(angle),
            "kr_right_ankle_y" => Some(5.0),
            "qr_right_ankle_y" => Some(-0.5),
            _ if name.starts_with("q_") => Some(0.1),
            _ if name.starts_with("qd_") => Some(0.0),
            _ => Some(0.3),
        });
        let [bias, gravity, slope] =
            evaluate(&robot.derivation.dag, &spring, &mut point).unwrap().try_into().unwrap();
        assert!((bias - gravity - torque).abs() < 1e-12, "{angle}: {}", bias - gravity);
        assert!((slope - gravity - torque).abs() < 1e-12, "{angle}: {}", slope - gravity);
    }
}

#[test]
fn derivatives_of_inverse_dynamics_are_its_symbolic_derivatives() {
    for_each_robot(&[InverseDynamics, InverseDynamicsDerivatives], |robot| {
        let tau = robot.entries(InverseDynamics, "tau");
        type Of = fn(&JointVariables) -> ExprId;
        let cases: [(&str, Of); 2] = [("dtau_dq", |joint| joint.q), ("dtau_dqd", |joint| joint.qd)];
        for (output, of) in cases {
            let n = robot.joints.len();
            let columns = robot.gradient(&tau, &robot.symbols(of));
            let fast = robot.entries(InverseDynamicsDerivatives, output);
            for seed in SEEDS {
                let fast = robot.values(&fast, seed);
                for (j, column) in columns.iter().enumerate() {
                    let column = robot.values(column, seed);
                    let own: Vec<_> = (0..n).map(|i| fast[i * n + j]).collect();
                    assert_eq!(own, column, "{}: {output}, column {j}", robot.name);
                }
            }
        }
    });
}

#[test]
fn derivatives_of_forward_dynamics_follow_from_the_implicit_equation() {
    // tau = ID(q, qd, FD(q, qd, tau)), so D dqdd/dx = -dID/dx at qdd = FD, and D dqdd/dtau = 1.
    let wanted =
        [ForwardDynamicsDerivatives, ForwardDynamics, MassMatrix, InverseDynamicsDerivatives];
    for_each_robot(&wanted, |robot| {
        let n = robot.joints.len();
        let seed = SEEDS[0];
        let qdd = robot.values(&robot.entries(ForwardDynamics, "qdd"), seed);
        let dag = &robot.derivation.dag;
        let point =
            robot.joints.iter().zip(qdd).fold(Residues::new(seed), |point, (joint, qdd)| {
                point.with(&dag.as_symbol(joint.qdd).unwrap().name, qdd)
            });
        let mut at_solution = point;
        let mut values = |function, output| {
            evaluate(dag, &robot.entries(function, output), &mut at_solution).unwrap()
        };
        let d = values(MassMatrix, "mass_matrix");
        let identity: Vec<_> = (0..n * n)
            .map(|k| if k % (n + 1) == 0 { -Residue::ONE } else { Residue::ZERO })
            .collect();
        let cases = [
            ("dqdd_dq", values(InverseDynamicsDerivatives, "dtau_dq")),
            ("dqdd_dqd", values(InverseDynamicsDerivatives, "dtau_dqd")),
            ("dqdd_dtau", identity),
        ];
        for (output, minus_right) in cases {
            let x = values(ForwardDynamicsDerivatives, output);
            for j in 0..n {
                let column: Vec<_> = (0..n).map(|i| x[i * n + j]).collect();
                let right: Vec<_> = (0..n).map(|i| -minus_right[i * n + j]).collect();
                assert_eq!(apply(&d, &column), right, "{}: {output}, column {j}", robot.name);
            }
        }
    });
}

#[test]
fn contact_jacobian_and_bias_are_derivatives_of_the_positions() {
    for_each_robot(&[ContactPositions, ContactJacobian, ContactBias], |robot| {
        if robot.derivation.functions.is_empty() {
            return;
        }
        let n = robot.joints.len();
        let h = robot.entries(ContactPositions, "contact_positions");
        let columns = robot.gradient(&h, &robot.symbols(|joint| joint.q));
        let velocity = robot.time_derivative(&h);
        let acceleration = robot.time_derivative(&velocity);
        for seed in SEEDS {
            let jacobian = robot.values(&robot.entries(ContactJacobian, "contact_jacobian"), seed);
            for (j, column) in columns.iter().enumerate() {
                let column = robot.values(column, seed);
                let own: Vec<_> = (0..h.len()).map(|row| jacobian[row * n + j]).collect();
                assert_eq!(own, column, "{}: column {j}", robot.name);
            }
            let qdd = robot.values(&robot.symbols(|joint| joint.qdd), seed);
            let bias = robot.values(&robot.entries(ContactBias, "contact_bias"), seed);
            let total = add(&apply(&jacobian, &qdd), &bias);
            assert_eq!(total, robot.values(&acceleration, seed), "{}", robot.name);
        }
    });
}

#[test]
fn link_jacobians_are_derivatives_of_the_link_transforms() {
    for_each_robot(&[LinkTransforms, LinkJacobian], |robot| {
        let n = robot.joints.len();
        let transforms = robot.entries(LinkTransforms, "link_transforms");
        let columns = robot.gradient(&transforms, &robot.symbols(|joint| joint.q));
        let seed = SEEDS[0];
        let at = robot.values(&transforms, seed);
        let columns: Vec<_> = columns.iter().map(|column| robot.values(column, seed)).collect();
        let jacobians: Vec<_> = robot
            .derivation
            .functions
            .iter()
            .filter(|function| function.name == LinkJacobian)
            .map(|function| robot.values(&function.entries(), seed))
            .collect();
        assert_eq!(jacobians.len() * 12, at.len());
        for (link, jacobian) in jacobians.iter().enumerate() {
            let entry = |values: &[Residue], row: usize, column: usize| {
                values[12 * link + 4 * row + column]
            };
            for j in 0..n {
                for k in 0..3 {
                    assert_eq!(jacobian[k * n + j], entry(&columns[j], k, 3), "{}", robot.name);
                }
                // dR/dq R^T = [w]x
                let spin = |a: usize, b: usize| {
                    (0..3).fold(Residue::ZERO, |sum, c| {
                        sum + entry(&columns[j], a, c) * entry(&at, b, c)
                    })
                };
                let w = [spin(2, 1), spin(0, 2), spin(1, 0)];
                for k in 0..3 {
                    assert_eq!(jacobian[(3 + k) * n + j], w[k], "{}: link {link}", robot.name);
                }
            }
        }
    });
}

#[test]
fn the_centre_of_mass_carries_the_momentum_and_the_potential_energy() {
    for_each_robot(
        &[CenterOfMass, CenterOfMassJacobian, Momentum, KineticEnergy, PotentialEnergy],
        |robot| {
            let n = robot.joints.len();
            let com = robot.entries(CenterOfMass, "center_of_mass");
            let columns = robot.gradient(&com, &robot.symbols(|joint| joint.q));
            let velocity = robot.time_derivative(&com);
            let jacobian = robot.entries(CenterOfMassJacobian, "center_of_mass_jacobian");
            let total = total_mass(robot);
            for seed in SEEDS {
                let jacobian = robot.values(&jacobian, seed);
                for (j, column) in columns.iter().enumerate() {
                    let own: Vec<_> = (0..3).map(|k| jacobian[k * n + j]).collect();
                    assert_eq!(own, robot.values(column, seed), "{}", robot.name);
                }
                let mass = robot.values(&[total], seed)[0];
                let linear = robot.values(&robot.entries(Momentum, "linear_momentum"), seed);
                let velocity = robot.values(&velocity, seed);
                let carried: Vec<_> = velocity.iter().map(|&v| mass * v).collect();
                assert_eq!(linear, carried, "{}", robot.name);
            }
        },
    );
}

/// The sum of the masses of all links that move.
pub(crate) fn total_mass(robot: &mut Derived) -> ExprId {
    let model = robot.derivation.robot.clone();
    let dag = &mut robot.derivation.dag;
    let mut total = dag.zero();
    for (id, link) in model.links.iter() {
        let moves = model.tree.path(id).iter().any(|&on| model.links[on].joint.variables.is_some());
        if let Some(body) = link.body.filter(|_| moves) {
            total = dag.add(total, body.mass);
        }
    }
    total
}

#[test]
fn momentum_of_a_free_robot_obeys_newton_and_euler() {
    // The first six equations of a floating base without base torques: dp/dt = m g, and the
    // angular momentum about the centre of mass does not change without contact.
    let model = load("tulip");
    let mut robot = Derived::new(&model, &[Momentum, InverseDynamics, CenterOfMassJacobian]);
    let linear = robot.entries(Momentum, "linear_momentum");
    let angular = robot.entries(Momentum, "angular_momentum");
    let linear_rate = robot.time_derivative(&linear);
    let angular_rate = robot.time_derivative(&angular);
    let total = total_mass(&mut robot);
    let gravity = robot.derivation.robot.gravity;
    for seed in SEEDS {
        let tau = robot.values(&robot.entries(InverseDynamics, "tau"), seed);
        let rate = robot.values(&linear_rate, seed);
        let mass = robot.values(&[total], seed)[0];
        let g = robot.values(&gravity, seed);
        // The base slides along z, x, y of the world: its forces are the rate of p minus weight.
        for (row, axis) in [(0, 2), (1, 0), (2, 1)] {
            assert_eq!(tau[row], rate[axis] - mass * g[axis], "force {axis}");
        }
        // Yaw, the first turning joint, is about the world's z axis through the base point o: its
        // torque is the rate of L about o along z, that is dLc/dt + (c - o) x (dp/dt - m g).
        let jacobian = robot.entries(CenterOfMassJacobian, "center_of_mass_jacobian");
        let jacobian = robot.values(&jacobian, seed);
        let n = robot.joints.len();
        // Column of yaw: z x (c - o) = (-(c - o)_y, (c - o)_x, 0).
        let (x, y) = (jacobian[n + 3], -jacobian[3]);
        let force = |axis: usize| rate[axis] - mass * g[axis];
        let spin = robot.values(&angular_rate, seed)[2];
        assert_eq!(tau[3], spin + x * force(1) - y * force(0), "yaw");
    }
}

/// What is left out because the model gives it as 0 is what all parameters give with zeros there.
#[test]
fn sparse_functions_are_those_of_all_parameters_with_zeros() {
    let wanted = [InverseDynamics, MassMatrix, CoriolisMatrix, GravityVector, ForwardDynamics];
    let mut left_out = 0;
    for name in shipped() {
        let robot = load(&name);
        let sparse = derive(&robot, Flavour::Sparse, &wanted).unwrap();
        let Derivation { mut dag, functions, .. } =
            derive(&robot, Flavour::Tunable, &wanted).unwrap();
        let is_kept = |name: &str| sparse.robot.find_parameter(name).is_some();
        let zero = dag.zero();
        let zeros: FxHashMap<ExprId, ExprId> = robot
            .parameters
            .values()
            .filter(|parameter| !is_kept(&parameter.name))
            .map(|parameter| (parameter.symbol, zero))
            .collect();
        left_out += zeros.len();
        for (own, full) in sparse.functions.iter().zip(&functions) {
            let with_zeros = substitute(&mut dag, &full.entries(), &zeros);
            for seed in SEEDS {
                let expected = evaluate(&dag, &with_zeros, &mut Residues::new(seed)).unwrap();
                let found = evaluate(&sparse.dag, &own.entries(), &mut Residues::new(seed));
                assert_eq!(found.unwrap(), expected, "{:?} of {name}", own.name);
            }
        }
    }
    assert!(left_out > 100, "{left_out}");
}
