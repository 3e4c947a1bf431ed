//! Newton and Euler's equations with explicit joint constraints, integrated as they stand (thesis
//! 2.2.1).
//!
//! Every link moves freely but for the constraints g = 0 of its joint, which the equations hold as
//! accelerations: g'' = 0. Errors of integration are not corrected; the error of g' grows in
//! proportion to time, that of g with its square. Baumgarte's terms hold
//! g'' + 2 b g' + b^2 g = 0 instead, so that errors decay at the rate b. Minimal coordinates have
//! no constraint to drift from.

use super::breakdown::Breakdown;
use super::integrate::{Method, Rates, Stepper};
use denavit_codegen::dynamics::methods::newton_euler::dae;
use denavit_codegen::expr::ExprId;
use denavit_codegen::function::{Argument, Form, Function, FunctionName, Output};
use denavit_codegen::model::{Robot, bake};
use denavit_codegen::program::{Evaluator, constant_values, lower};
use denavit_plants::Plant;
use nalgebra::{DMatrix, DVector};

/// Entries of the state of a link: place of its centre of mass, rotation by rows, velocity, angular
/// velocity.
const STATE: usize = 18;
/// Of these, place and rotation.
const POSITION: usize = 12;
/// Velocities of a link.
const VELOCITY: usize = 6;

/// Free links with the constraints of their joints, by interpreting [`dae()`]. No drive acts.
pub struct ConstrainedBodies {
    equations: Evaluator<f64>,
    links: usize,
    joints: usize,
    constraints: usize,
    /// Centre of mass of each link in its frame \[m\].
    centers: Vec<[f64; 3]>,
    /// b [1/s].
    stabilisation: f64,
    arguments: [Vec<f64>; 3],
    outputs: Vec<f64>,
}

/// How far a run is off at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriftSample {
    /// \[s\].
    pub t_s: f64,
    /// Largest residual of a joint's constraints, of bodies \[m, or a cosine\].
    pub constraint: f64,
    /// Largest rate of a residual.
    pub constraint_rate: f64,
    /// Largest distance of a centre of mass from where minimal coordinates have it \[m\].
    pub distance_m: f64,
    /// Energy of the motion in minimal coordinates, less that of the start \[J\].
    pub minimal_energy_j: f64,
}

impl ConstrainedBodies {
    /// The equations of a robot all of whose parameters have values.
    pub fn new(robot: &Robot, stabilisation_per_s: f64) -> Result<Self, denavit_plants::Error> {
        let robot = bake(robot)?;
        let mut dag = robot.dag.clone();
        let equations = dae(&mut dag, &robot);
        let (mut positions, mut velocities) = (Vec::new(), Vec::new());
        for body in &equations.bodies {
            positions.extend(body.position);
            positions.extend(body.rotation.into_iter().flatten());
            velocities.extend(body.velocity);
            velocities.extend(body.angular_velocity);
        }
        let efforts: Vec<ExprId> = robot.joints().map(|(_, variables)| variables.tau).collect();
        let output = |entries: Vec<ExprId>| Output {
            name: "entries",
            shape: vec![entries.len()],
            entries,
            doc: String::new(),
            details: Vec::new(),
        };
        let (constraints, joints) = (equations.constraints.len(), efforts.len());
        let entries = [
            equations.mass_matrix.concat(),
            equations.forces,
            equations.constraints,
            equations.constraint_jacobian.concat(),
            equations.constraint_bias,
        ]
        .concat();
        let argument = |name, symbols| Argument { name, symbols };
        let function = Function {
            name: FunctionName::ForwardDynamics,
            link: None,
            arguments: vec![
                argument("q", positions),
                argument("qd", velocities),
                argument("tau", efforts),
            ],
            outputs: vec![output(entries)],
            form: Form::Plain,
        };
        let program = lower(&dag, &[function])?;
        let routine = program.routines.first().expect("one function was lowered");
        let center = |link: &denavit_codegen::model::Link| {
            let com = link.body.map(|body| constant_values(&robot.dag, &body.com));
            com.map_or([0.0; 3], |com| [com[0], com[1], com[2]])
        };
        let links = robot.links.len();
        Ok(Self {
            outputs: vec![0.0; routine.outputs.iter().map(|output| output.len()).sum()],
            equations: Evaluator::new(routine, &[]),
            links,
            joints,
            constraints,
            centers: robot.links.values().map(center).collect(),
            stabilisation: stabilisation_per_s,
            arguments: [
                vec![0.0; POSITION * links],
                vec![0.0; VELOCITY * links],
                vec![0.0; joints],
            ],
        })
    }

    /// The state at rest of the links as the joints hold them.
    fn resting(&self, plant: &mut dyn Plant, q: &[f64]) -> Vec<f64> {
        let mut state = vec![0.0; STATE * self.links];
        let places = self.centers_of_mass(plant, q);
        let mut transforms = vec![0.0; 12 * self.links];
        plant.link_transforms(q, &mut transforms);
        for (link, part) in state.chunks_exact_mut(STATE).enumerate() {
            part[..3].copy_from_slice(&places[link]);
            let rows = &transforms[12 * link..12 * (link + 1)];
            for (row, entries) in rows.chunks_exact(4).enumerate() {
                part[3 + 3 * row..6 + 3 * row].copy_from_slice(&entries[..3]);
            }
        }
        state
    }

    fn centers_of_mass(&self, plant: &mut dyn Plant, q: &[f64]) -> Vec<[f64; 3]> {
        let mut transforms = vec![0.0; 12 * self.links];
        plant.link_transforms(q, &mut transforms);
        let place = |(rows, center): (&[f64], &[f64; 3])| {
            std::array::from_fn(|axis| {
                let row = &rows[4 * axis..4 * axis + 4];
                row[3] + row[..3].iter().zip(center).map(|(r, c)| r * c).sum::<f64>()
            })
        };
        transforms.chunks_exact(12).zip(&self.centers).map(place).collect()
    }

    /// Evaluates M, F, g, A and gamma.
    fn evaluate(&mut self, y: &[f64]) {
        for (link, part) in y.chunks_exact(STATE).enumerate() {
            let [positions, velocities, _] = &mut self.arguments;
            positions[POSITION * link..POSITION * (link + 1)].copy_from_slice(&part[..POSITION]);
            velocities[VELOCITY * link..VELOCITY * (link + 1)].copy_from_slice(&part[POSITION..]);
        }
        let [positions, velocities, efforts] = &self.arguments;
        self.equations
            .evaluate(&[positions, velocities, efforts], &mut self.outputs)
            .expect("the vectors have the sizes of the equations");
    }

    /// Residuals, and their rates A (v, w), after `evaluate`.
    fn residuals(&self) -> (DVector<f64>, DVector<f64>) {
        let (n, c) = (VELOCITY * self.links, self.constraints);
        let start = n * n + n;
        let residual = DVector::from_column_slice(&self.outputs[start..start + c]);
        let jacobian = DMatrix::from_row_slice(c, n, &self.outputs[start + c..start + c + c * n]);
        let rate = jacobian * DVector::from_column_slice(&self.arguments[1]);
        (residual, rate)
    }

    /// Runs the robot from rest by classical Runge-Kutta steps, beside the same in minimal
    /// coordinates; a sample every `sample_s`.
    pub fn run(
        &mut self,
        plant: &mut dyn Plant,
        q: &[f64],
        step_s: f64,
        sample_s: f64,
        samples: usize,
    ) -> Result<Vec<DriftSample>, Breakdown> {
        assert_eq!(q.len(), self.joints, "a position for every joint");
        let method = Method::RungeKutta { step_s };
        let mut bodies = Stepper::new(method, 0.0, &self.resting(plant, q));
        let mut joints = Stepper::new(method, 0.0, &[q, &vec![0.0; q.len()]].concat());
        let start = energy(plant, joints.state());
        let mut found = vec![DriftSample::default()];
        for sample in 1..=samples {
            let t_s = sample as f64 * sample_s;
            while bodies.time() < t_s {
                bodies.advance(self, t_s)?;
            }
            while joints.time() < t_s {
                joints.advance(&mut Minimal { plant }, t_s)?;
            }
            let y = bodies.state().to_vec();
            self.evaluate(&y);
            let (residual, rate) = self.residuals();
            let places = self.centers_of_mass(plant, &joints.state()[..q.len()]);
            let apart = y.chunks_exact(STATE).zip(places).map(|(part, place)| {
                (0..3).map(|axis| (part[axis] - place[axis]).powi(2)).sum::<f64>().sqrt()
            });
            found.push(DriftSample {
                t_s,
                constraint: residual.amax(),
                constraint_rate: rate.amax(),
                distance_m: apart.fold(0.0, f64::max),
                minimal_energy_j: energy(plant, joints.state()) - start,
            });
        }
        Ok(found)
    }
}

fn energy(plant: &mut dyn Plant, y: &[f64]) -> f64 {
    let (q, qd) = y.split_at(y.len() / 2);
    plant.kinetic_energy(q, qd) + plant.potential_energy(q)
}

impl Rates for ConstrainedBodies {
    fn rates(&mut self, _t_s: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Breakdown> {
        self.evaluate(y);
        let (n, c, b) = (VELOCITY * self.links, self.constraints, self.stabilisation);
        let (residual, rate) = self.residuals();
        let (mass, rest) = self.outputs.split_at(n * n);
        let (force, rest) = rest.split_at(n);
        let (jacobian, bias) = rest[c..].split_at(c * n);
        // [M -A^T; A 0] (a, lambda) = (F, gamma - 2 b g' - b^2 g)
        let mut matrix = DMatrix::zeros(n + c, n + c);
        let mut right = DVector::zeros(n + c);
        for i in 0..n {
            right[i] = force[i];
            for j in 0..n {
                matrix[(i, j)] = mass[i * n + j];
            }
        }
        for k in 0..c {
            right[n + k] = bias[k] - b * (2.0 * rate[k] + b * residual[k]);
            for j in 0..n {
                matrix[(n + k, j)] = jacobian[k * n + j];
                matrix[(j, n + k)] = -jacobian[k * n + j];
            }
        }
        let solved = matrix.lu().solve(&right).ok_or(Breakdown::Singular { coordinate: 0 })?;
        for (link, (part, rates)) in
            y.chunks_exact(STATE).zip(dy.chunks_exact_mut(STATE)).enumerate()
        {
            rates[..3].copy_from_slice(&part[POSITION..POSITION + 3]);
            let [wx, wy, wz] = [part[POSITION + 3], part[POSITION + 4], part[POSITION + 5]];
            for column in 0..3 {
                let [x, y, z] = [0, 1, 2].map(|row| part[3 + 3 * row + column]);
                rates[3 + column] = wy * z - wz * y;
                rates[6 + column] = wz * x - wx * z;
                rates[9 + column] = wx * y - wy * x;
            }
            for entry in 0..VELOCITY {
                rates[POSITION + entry] = solved[VELOCITY * link + entry];
            }
        }
        match dy.iter().all(|rate| rate.is_finite()) {
            true => Ok(()),
            false => Err(Breakdown::NotFinite),
        }
    }
}

/// The free motion of a plant without drives.
struct Minimal<'a> {
    plant: &'a mut dyn Plant,
}

impl Rates for Minimal<'_> {
    fn rates(&mut self, _t_s: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Breakdown> {
        let n = y.len() / 2;
        let (q, qd) = y.split_at(n);
        let (mut mass, mut bias) = (vec![0.0; n * n], vec![0.0; n]);
        self.plant.mass_matrix(q, &mut mass);
        self.plant.bias(q, qd, &mut bias);
        let matrix = DMatrix::from_row_slice(n, n, &mass);
        let solved = matrix.lu().solve(&-DVector::from_vec(bias));
        let acceleration = solved.ok_or(Breakdown::Singular { coordinate: 0 })?;
        dy[..n].copy_from_slice(qd);
        dy[n..].copy_from_slice(acceleration.as_slice());
        Ok(())
    }
}
