//! The plant: rigid bodies, drives with transmissions, dry friction that sticks, hidden effects.
//!
//! Dry friction is set-valued at rest. Each drive slides in a direction or sticks; a mode stays for
//! one step. A rate that has changed its sign within the step is set to 0 and sticks; a stuck drive
//! is let go when the torque that holds it exceeds its breakaway friction (Karnopp 1985). So no law
//! is smoothed and no equation is stiff.

use super::hidden::{Hidden, Law};
use super::laws::Moment;
use super::rigid::{MOST, Posture, Row};
use super::robots::Robot;
use nalgebra::Vector3;

/// What joins a drive to its joint where that is not rigid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transmission {
    pub joint: usize,
    /// [N m/rad]
    pub stiffness: f64,
    /// [N m s/rad]
    pub damping: f64,
    /// Width of play \[rad\].
    pub play: f64,
    /// Whether the play has soft edges.
    pub soft: bool,
}

impl Transmission {
    /// Torque that reaches the joint [N m].
    fn torque(&self, stretch: f64, rate: f64) -> f64 {
        let half = 0.5 * self.play;
        if half == 0.0 {
            return self.stiffness * stretch + self.damping * rate;
        }
        let beyond = (stretch.abs() - half).max(0.0);
        let pressed = if self.soft { beyond * beyond / (beyond + half) } else { beyond };
        let elastic = self.stiffness * pressed * stretch.signum();
        if pressed > 0.0 { elastic + self.damping * rate } else { 0.0 }
    }
}

/// A robot with drives, as it really is.
#[derive(Clone, Debug)]
pub struct Plant {
    pub rows: Vec<Row>,
    pub fall: Vector3<f64>,
    /// Of each drive, on the joint's side.
    pub rotor: Vec<f64>,
    pub viscous: Vec<f64>,
    pub coulomb: Vec<f64>,
    pub transmissions: Vec<Transmission>,
    pub hidden: Vec<Hidden>,
    /// Random numbers of forces that are not recorded.
    pub seed: f64,
}

/// A state: angles and rates of joints, then of the drives behind transmissions, then states of
/// effects; which drives stick, and how others slide; loads of the joints.
#[derive(Clone, Debug)]
pub struct State {
    pub t: f64,
    pub y: Vec<f64>,
    slide: Vec<f64>,
    load: Vec<f64>,
    /// Torques of the drives beside their commands [N m].
    pub push: Vec<f64>,
}

type Matrix = [[f64; MOST]; MOST];

impl Plant {
    /// A robot with its drives and springs, and laws that act on its coordinates.
    pub fn new(robot: &Robot, hidden: Vec<Hidden>) -> Self {
        let joints = 0..robot.joints.len();
        let [rotor, viscous, coulomb] =
            [0, 1, 2].map(|k| joints.clone().map(|joint| robot.joint_side(joint)[k]).collect());
        let springs = joints.filter_map(|joint| {
            let spring = robot.joints[joint].drive.spring?;
            let stiffness = spring.stiffness * spring.radius * spring.radius;
            Some(Transmission { joint, stiffness, damping: 0.0, play: 0.0, soft: false })
        });
        let (rows, fall, transmissions) = (robot.rows(), robot.fall, springs.collect());
        Self { rows, fall, rotor, viscous, coulomb, transmissions, hidden, seed: 0.0 }
    }

    fn joints(&self) -> usize {
        self.rows.len()
    }

    fn freedoms(&self) -> usize {
        self.rows.len() + self.transmissions.len()
    }

    /// Coordinate of the drive of a joint.
    fn drive(&self, joint: usize) -> usize {
        let behind = self.transmissions.iter().position(|one| one.joint == joint);
        behind.map_or(joint, |index| self.joints() + index)
    }

    /// A start at angles and rates, transmissions relaxed.
    pub fn start(&self, t: f64, q: &[f64], qd: &[f64]) -> State {
        let mut y = q.to_vec();
        y.extend(self.transmissions.iter().map(|one| q[one.joint]));
        y.extend_from_slice(qd);
        y.extend(self.transmissions.iter().map(|one| qd[one.joint]));
        for hidden in &self.hidden {
            let begin = y.len();
            y.resize(begin + hidden.states(), 0.0);
            hidden.start(&mut y[begin..], self.seed);
        }
        let sign = |v: &f64| if *v == 0.0 { 0.0 } else { v.signum() };
        let slide = qd.iter().map(sign).collect();
        let [load, push] = [0, 1].map(|_| vec![0.0; self.joints()]);
        State { t, y, slide, load, push }
    }

    /// Angles of the drives in the joints' units.
    pub fn motors(&self, y: &[f64]) -> [f64; MOST] {
        let mut motors = [0.0; MOST];
        for (joint, motor) in motors[..self.joints()].iter_mut().enumerate() {
            *motor = y[self.drive(joint)];
        }
        motors
    }

    fn motor_rates(&self, y: &[f64]) -> [f64; MOST] {
        self.motors(&y[self.freedoms()..])
    }

    /// Friction of the drive of a joint: kinetic and breakaway [N m].
    fn dry(&self, at: &Moment<'_>, joint: usize, direction: f64, states: &[f64]) -> [f64; 2] {
        let mut level = [self.coulomb[joint]; 2];
        let mut from = 0;
        for hidden in &self.hidden {
            let until = from + hidden.states();
            if hidden.joint == joint {
                let more = hidden.dry(at, direction, &states[from..until]);
                level = [level[0] + more[0], level[1] + more[1]];
            }
            from = until;
        }
        level.map(|level| level.max(0.0))
    }

    /// Torque that the drive of a joint really gives [N m].
    fn delivered(&self, joint: usize, command: f64, states: &[f64]) -> f64 {
        let mut given = command;
        let mut from = 0;
        for hidden in &self.hidden {
            let until = from + hidden.states();
            let soft = if hidden.variant == 0 { 0.0 } else { 0.3 };
            let bound = hidden.shape.peak * (1.0 + soft - hidden.size);
            given = match (hidden.law, hidden.variant) {
                _ if hidden.joint != joint => given,
                (Law::Saturation, 0) => given.clamp(-bound, bound),
                (Law::Saturation, _) => given / (1.0 + (given / bound).powi(16)).powf(0.0625),
                (Law::ActuatorLag, _) => states[until - 1],
                _ => given,
            };
            from = until;
        }
        given
    }

    /// Forces that no sensor sees, as joint torques that they need.
    fn disturbance(&self, t: f64, posture: &Posture, torques: &mut [f64]) {
        torques.fill(0.0);
        let forces = self.hidden.iter().filter(|hidden| hidden.law == Law::ExternalForce);
        for hidden in forces {
            let wave = |k: f64| (t * (2.1 + 1.7 * k + self.seed) + 9.0 * k * self.seed).sin();
            let size = if hidden.variant == 0 {
                wave(1.0) + wave(2.3) * wave(0.37)
            } else {
                // pushes at times that no lap knows
                (4.0 * (wave(0.2) * wave(0.9) - 0.35)).clamp(0.0, 1.0) * 2.0
            };
            let angle = hidden.shape.phase;
            let push = Vector3::new(angle.cos(), angle.sin(), 0.5) * (size * hidden.size);
            posture.of_tip_force(&push, torques);
        }
    }

    /// Rates of a state under commands; a drive with `slide` 0 sticks.
    fn rates(&self, state: &State, y: &[f64], t: f64, command: &[f64], dy: &mut [f64]) -> Solved {
        let (joints, freedoms) = (self.joints(), self.freedoms());
        let (q, rest) = y.split_at(freedoms);
        let (v, states) = rest.split_at(freedoms);
        let motor_rate = self.motor_rates(y);
        let at = Moment {
            t,
            q: &q[..joints],
            qd: &v[..joints],
            motor_rate: &motor_rate[..joints],
            load: &state.load,
            coulomb: &self.coulomb,
            viscous: &self.viscous,
        };
        let posture = Posture::new(&self.rows, at.q);
        let (mut bias, mut pushed) = ([0.0; MOST], [0.0; MOST]);
        posture.torques(at.qd, &[0.0; MOST], &self.fall, &mut bias[..joints]);
        self.disturbance(t, &posture, &mut pushed[..joints]);
        let mut force = [0.0; MOST];
        for joint in 0..joints {
            force[joint] -= bias[joint] + pushed[joint];
            let given = self.delivered(joint, command[joint], states) + state.push[joint];
            force[self.drive(joint)] += given - self.viscous[joint] * motor_rate[joint];
        }
        for one in &self.transmissions {
            let (joint, drive) = (one.joint, self.drive(one.joint));
            let torque = one.torque(q[drive] - q[joint], v[drive] - v[joint]);
            force[joint] += torque;
            force[drive] -= torque;
        }
        dy[..freedoms].copy_from_slice(v);
        let mut from = 0;
        for hidden in &self.hidden {
            let until = from + hidden.states();
            let (z, dz) =
                (&states[from..until], &mut dy[2 * freedoms + from..2 * freedoms + until]);
            hidden.rates(&at, z, dz);
            lag(hidden, command, z, dz);
            let torque = hidden.smooth(&at, z, dz);
            let drive = self.drive(hidden.joint);
            force[if hidden.is_on_drive() { drive } else { hidden.joint }] -= torque;
            if hidden.law == Law::CoupledFriction {
                force[self.drive(hidden.other)] -= torque;
            }
            from = until;
        }
        let mut levels = [[0.0; 2]; MOST];
        for joint in 0..joints {
            let direction = state.slide[joint];
            levels[joint] = self.dry(&at, joint, direction, states);
            force[self.drive(joint)] -= direction * levels[joint][0];
        }
        let mut solved = self.solve(&posture, &force, state);
        for joint in 0..joints {
            let row = &solved.matrix[joint][..joints];
            let pull = row.iter().zip(&solved.rates).map(|(entry, rate)| entry * rate);
            solved.load[joint] = pull.sum::<f64>() + bias[joint];
        }
        dy[freedoms..2 * freedoms].copy_from_slice(&solved.rates[..freedoms]);
        solved.breakaway = levels.map(|level| level[1]);
        solved
    }

    /// Accelerations of everything that does not stick.
    fn solve(&self, posture: &Posture, force: &[f64; MOST], state: &State) -> Solved {
        let (joints, freedoms) = (self.joints(), self.freedoms());
        let mut rigid = [[0.0; MOST]; MOST];
        posture.mass_matrix(&mut rigid);
        let mut matrix = rigid;
        let mut stuck = [false; MOST];
        for joint in 0..joints {
            let drive = self.drive(joint);
            matrix[drive][drive] += self.rotor[joint];
            stuck[drive] = state.slide[joint] == 0.0;
        }
        for hidden in self.hidden.iter().filter(|one| one.law == Law::CouplingInertia) {
            let (one, other) = (self.drive(hidden.joint), self.drive(hidden.other));
            matrix[one][other] += hidden.size;
            matrix[other][one] += hidden.size;
        }
        let free: Vec<usize> = (0..freedoms).filter(|index| !stuck[*index]).collect();
        let rates = cholesky_solve(&matrix, force, &free);
        let mut hold = [0.0; MOST];
        for joint in 0..joints {
            let row = &matrix[self.drive(joint)];
            let pull: f64 =
                row[..freedoms].iter().zip(&rates).map(|(entry, rate)| entry * rate).sum();
            hold[joint] = force[self.drive(joint)] - pull;
        }
        Solved { rates, hold, matrix: rigid, load: [0.0; MOST], breakaway: [0.0; MOST] }
    }

    /// One step of the classical method of Runge and Kutta.
    pub fn step(&self, state: &mut State, command: &[f64], step_s: f64) {
        let count = state.y.len();
        let freedoms = self.freedoms();
        let mut slopes = [vec![0.0; count], vec![0.0; count], vec![0.0; count], vec![0.0; count]];
        self.let_go(state, command, &mut slopes[0]);
        let mut y = state.y.clone();
        let mut breakaway = [0.0; MOST];
        for stage in 0..4 {
            let (done, ahead) = slopes.split_at_mut(stage);
            let part = [0.0, 0.5, 0.5, 1.0][stage] * step_s;
            if let Some(slope) = done.last() {
                for (index, value) in y.iter_mut().enumerate() {
                    *value = state.y[index] + part * slope[index];
                }
            }
            let solved = self.rates(state, &y, state.t + part, command, &mut ahead[0]);
            state.load.copy_from_slice(&solved.load[..self.joints()]);
            breakaway = solved.breakaway;
        }
        for index in 0..count {
            let [a, b, c, d] = [0, 1, 2, 3].map(|stage| slopes[stage][index]);
            state.y[index] += step_s / 6.0 * (a + 2.0 * (b + c) + d);
        }
        state.t += step_s;
        for joint in 0..self.joints() {
            let rate = &mut state.y[freedoms + self.drive(joint)];
            if *rate * state.slide[joint] > 0.0 || state.slide[joint] == 0.0 {
                continue;
            }
            if breakaway[joint] > 0.0 {
                state.slide[joint] = 0.0;
                *rate = 0.0;
            } else {
                state.slide[joint] = rate.signum();
            }
        }
    }

    /// Lets go of drives that are pulled harder than they stick.
    fn let_go(&self, state: &mut State, command: &[f64], slope: &mut [f64]) {
        for _ in 0..self.joints() {
            if state.slide.iter().all(|slide| *slide != 0.0) {
                return;
            }
            let solved = self.rates(state, &state.y, state.t, command, slope);
            let over = |joint: &usize| {
                state.slide[*joint] == 0.0 && solved.hold[*joint].abs() > solved.breakaway[*joint]
            };
            let going: Vec<usize> = (0..self.joints()).filter(over).collect();
            if going.is_empty() {
                return;
            }
            for joint in going {
                state.slide[joint] = solved.hold[joint].signum();
            }
        }
    }

    /// Kinetic and potential energy \[J\], with that of the springs.
    pub fn energy(&self, state: &State) -> f64 {
        let (joints, freedoms) = (self.joints(), self.freedoms());
        let (q, v) = state.y.split_at(freedoms);
        let posture = Posture::new(&self.rows, &q[..joints]);
        let mut matrix = [[0.0; MOST]; MOST];
        posture.mass_matrix(&mut matrix);
        for joint in 0..joints {
            matrix[self.drive(joint)][self.drive(joint)] += self.rotor[joint];
        }
        let mut energy = posture.potential(&self.fall);
        for row in 0..freedoms {
            for column in 0..freedoms {
                energy += 0.5 * v[row] * matrix[row][column] * v[column];
            }
        }
        let stretch = |one: &Transmission| q[self.drive(one.joint)] - q[one.joint];
        let springs = self.transmissions.iter();
        energy + springs.map(|one| 0.5 * one.stiffness * stretch(one).powi(2)).sum::<f64>()
    }
}

/// Accelerations, the torque that each drive lacks to move as it does, and the mass matrix.
struct Solved {
    rates: [f64; MOST],
    hold: [f64; MOST],
    matrix: Matrix,
    load: [f64; MOST],
    breakaway: [f64; MOST],
}

/// Current loops: first order, or two of half the time constant one after the other.
fn lag(hidden: &Hidden, command: &[f64], z: &[f64], dz: &mut [f64]) {
    if hidden.law == Law::ActuatorLag {
        let time_s = hidden.size / z.len() as f64;
        let mut input = command[hidden.joint];
        for (rate, state) in dz.iter_mut().zip(z) {
            *rate = (input - state) / time_s;
            input = *state;
        }
    }
}

/// Solves the rows and columns `free` of a positive definite matrix; 0 elsewhere.
fn cholesky_solve(matrix: &Matrix, force: &[f64; MOST], free: &[usize]) -> [f64; MOST] {
    let count = free.len();
    let (mut lower, mut x) = ([[0.0; MOST]; MOST], [0.0; MOST]);
    for row in 0..count {
        let mut right = force[free[row]];
        for column in 0..=row {
            let done = (0..column).map(|k| lower[row][k] * lower[column][k]).sum::<f64>();
            let entry = matrix[free[row]][free[column]] - done;
            lower[row][column] =
                if row == column { entry.sqrt() } else { entry / lower[column][column] };
        }
        for column in 0..row {
            right -= lower[row][column] * x[column];
        }
        x[row] = right / lower[row][row];
    }
    for row in (0..count).rev() {
        let known = (row + 1..count).map(|k| lower[k][row] * x[k]).sum::<f64>();
        x[row] = (x[row] - known) / lower[row][row];
    }
    let mut rates = [0.0; MOST];
    for (index, value) in free.iter().zip(x) {
        rates[*index] = value;
    }
    rates
}
