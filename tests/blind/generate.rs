//! From a case to its files: sizes of effects by simulation, two logs, a model, a sealed answer.

use super::case::Case;
use super::conditions::{Disturbance, Recording};
use super::design::{Kind, STRENGTHS};
use super::experiment::{Log, Run, measure, run};
use super::hidden::{Hidden, Law, Site};
use super::nominal::Nominal;
use super::random::Random;
use super::robots::ROBOTS;
use super::strength::{CUTOFF_HZ, left};
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

/// A case with its logs.
#[derive(Clone, Debug)]
pub struct Generated {
    pub case: Case,
    pub train: Log,
    pub validate: Log,
    /// What each effect alone leaves, against what noise leaves; largest over joints for effects
    /// that are not of one joint.
    pub strengths: Vec<f64>,
    /// What noise leaves at each joint, then at each spring [N m].
    pub floor: Vec<f64>,
}

/// Sizes within this factor of the strength are good enough.
const CLOSE: f64 = 1.08;
const ROUNDS: usize = 7;

impl Case {
    fn run(&self, hidden: &[Hidden], log: usize) -> Option<Run> {
        let plant = self.plant(hidden, log);
        run(
            &plant,
            // the controller's designer had the same file as the diagnosis
            &self.nominal,
            &self.control,
            &self.references[log],
            self.duration_s,
            &mut Disturbance::new(&self.disturbance, self.random("disturbance", log)),
        )
    }

    /// Random numbers of one of the two logs.
    fn random(&self, of: &str, log: usize) -> Random {
        Random::new(self.number, &format!("{of} of {}", ["train", "validate"][log]))
    }

    /// A log on the grid of its rows, as strengths are measured.
    fn measured(&self, run: &Run, hidden: &[Hidden], log: usize) -> Log {
        self.recorded(run, hidden, log, &Recording::default())
    }

    fn recorded(&self, run: &Run, hidden: &[Hidden], log: usize, recording: &Recording) -> Log {
        let [mut noise, mut times] = ["noise", "times"].map(|of| self.random(of, log));
        measure(run, &self.sensors, hidden, &mut noise, recording, &mut times)
    }

    /// The true robot with the stated uncertainty: strength is not a matter of wrong numbers. It
    /// lacks the terms that the nominal model lacks, or has them.
    fn yardstick(&self, lacks: bool) -> Nominal {
        let mut whole = Nominal { robot: self.truth.clone(), ..self.nominal.clone() };
        whole.coriolis |= !lacks;
        let lacking = self.hidden.iter().filter(|one| lacks && one.law == Law::RotorInertia);
        for one in lacking {
            whole.robot.joints[one.joint].drive.rotor = 0.0;
        }
        whole
    }

    fn left(&self, log: &Log, lacks: bool) -> Vec<f64> {
        left(log, &self.yardstick(lacks), &self.sensors.torque_noise)
    }

    /// How strong one effect is in a log that has only it.
    fn strength(&self, hidden: &Hidden, floor: &[f64]) -> Option<f64> {
        let alone = [hidden.clone()];
        let log = self.measured(&self.run(&alone, 0)?, &alone, 0);
        let left = self.left(&log, hidden.law.is_lacking());
        let ratio = |joint: usize| ((left[joint] / floor[joint]).powi(2) - 1.0).max(0.0).sqrt();
        let joints = self.truth.joints.len();
        let largest = || (0..floor.len()).map(ratio).fold(0.0, f64::max);
        let strength = match hidden.law.entry().site {
            Site::Joint => {
                let springs = self.nominal.elastic_joints();
                let spring = springs.zip(joints..).find(|(joint, _)| *joint == hidden.joint);
                ratio(hidden.joint).max(spring.map_or(0.0, |(_, equation)| ratio(equation)))
            }
            _ => largest(),
        };
        strength.is_finite().then_some(strength)
    }

    /// Size of an effect that has the strength, by steps of the secant in logarithms, and the
    /// strength that it reached: some effects cannot be made strong.
    fn scale(&self, hidden: &mut Hidden, floor: &[f64], target: f64) -> f64 {
        let [guess, most] = hidden.bounds(floor[hidden.joint] * target, &self.plant(&[], 0).rotor);
        hidden.size = guess.min(most);
        let mut best: Option<(f64, f64)> = None;
        let mut before: Option<(f64, f64)> = None;
        for _ in 0..ROUNDS {
            let Some(reached) = self.strength(hidden, floor) else {
                hidden.size *= 0.5;
                before = None;
                continue;
            };
            let reached = reached.max(1e-3);
            let miss = (reached / target).ln().abs();
            if best.is_none_or(|(_, old)| miss < (old / target).ln().abs()) {
                best = Some((hidden.size, reached));
            }
            if miss < CLOSE.ln() || (hidden.size >= most && reached < target) {
                break;
            }
            let slope = before.map_or(1.0, |(size, strength)| {
                let slope = (reached / strength).ln() / (hidden.size / size).ln();
                if slope.is_finite() { slope.clamp(0.3, 4.0) } else { 1.0 }
            });
            before = Some((hidden.size, reached));
            let factor = ((target / reached).ln() / slope).clamp(-3.0, 3.0).exp();
            hidden.size = (hidden.size * factor).min(most);
        }
        let (size, reached) = best.unwrap_or((hidden.size, 0.0));
        hidden.size = size;
        reached
    }

    /// Typical rates and torques, as of the robot without effects.
    fn fill_shapes(&mut self, run: &Run) {
        let rms = |x: &[f64]| (x.iter().map(|x| x * x).sum::<f64>() / x.len() as f64).sqrt();
        for hidden in &mut self.hidden {
            let shape = &mut hidden.shape;
            [shape.middle, shape.reach] = span(&run.q[hidden.joint]);
            [shape.other_middle, shape.other_reach] = span(&run.q[hidden.other]);
            shape.rate = rms(&run.qd[hidden.joint]);
            shape.torque = rms(&run.command[hidden.joint]);
            shape.peak = run.command[hidden.joint].iter().fold(0.0, |most, u| most.max(u.abs()));
            shape.lap_s = self.references[0].lap_s;
        }
        let noises = run.command.iter().map(|command| self.relative_noise * rms(command));
        self.sensors.torque_noise = noises.collect();
        if self.relative_disturbance > 0.0 {
            let peak =
                |command: &Vec<f64>| command.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
            let sizes = run.command.iter().map(|command| self.relative_disturbance * peak(command));
            self.disturbance = sizes.collect();
        }
    }

    /// Simulates the case.
    pub fn generate(mut self) -> Generated {
        let mut plain = self.run(&[], 0).expect("the plain robot follows its reference");
        self.fill_shapes(&plain);
        if !self.disturbance.is_empty() {
            plain = self.run(&[], 0).expect("the disturbed robot follows its reference");
        }
        let mut strengths = Vec::new();
        let mut floor = self.left(&self.measured(&plain, &[], 0), false);
        if self.hidden.len() == 1 && self.hidden[0].law.is_lacking() {
            floor = self.scale_noise(&plain, floor);
        }
        for index in 0..self.hidden.len() {
            let mut hidden = self.hidden[index].clone();
            if self.plan.still {
                // what would be seen if the robot moved as far as it can
                hidden.size = 0.02 * hidden.bounds(self.target * floor[hidden.joint], &[])[0];
            }
            strengths.push(if self.plan.still || hidden.law.is_lacking() {
                self.strength(&hidden, &floor).unwrap_or(0.0)
            } else {
                self.scale(&mut hidden, &floor, self.target)
            });
            self.hidden[index] = hidden;
        }
        // together effects may do what none does alone
        let mut rounds = 0;
        while [0, 1].iter().any(|log| self.run(&self.hidden, *log).is_none()) {
            rounds += 1;
            assert!(rounds < 30, "case {}: its plant cannot be integrated", self.number);
            self.hidden.iter_mut().for_each(|one| one.size *= 0.7);
        }
        let hidden = self.hidden.clone();
        let [train, validate] = [0, 1].map(|log| {
            let run = self.run(&hidden, log).expect("it ran before");
            self.recorded(&run, &hidden, log, &self.recording)
        });
        Generated { case: self, train, validate, strengths, floor }
    }

    /// Of an effect without a size the noise is scaled instead. Returns what noise leaves.
    fn scale_noise(&mut self, plain: &Run, mut floor: Vec<f64>) -> Vec<f64> {
        for _ in 0..ROUNDS {
            let strength = self.strength(&self.hidden[0], &floor).unwrap_or(self.target);
            if (strength / self.target).ln().abs() < CLOSE.ln() {
                break;
            }
            let factor = (strength / self.target).clamp(0.1, 10.0);
            self.sensors.torque_noise.iter_mut().for_each(|noise| *noise *= factor);
            self.sensors.resolution *= factor.min(2.0);
            floor = self.left(&self.measured(plain, &[], 0), false);
        }
        floor
    }
}

/// Middle and half of the width of what a signal covers.
fn span(signal: &[f64]) -> [f64; 2] {
    let low = signal.iter().copied().fold(f64::INFINITY, f64::min);
    let high = signal.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [0.5 * (low + high), 0.5 * (high - low)]
}

impl Hidden {
    /// A size that makes about this torque [N m], and the largest that is sensible.
    fn bounds(&self, torque: f64, rotor: &[f64]) -> [f64; 2] {
        let shape = &self.shape;
        let (rate, usual) = (shape.rate, shape.torque.max(1e-6));
        let acceleration = 4.0 * rate;
        let relative = torque / usual;
        let own = rotor.get(self.joint).copied().unwrap_or(0.1);
        let other = rotor.get(self.other).copied().unwrap_or(0.1);
        match self.law {
            Law::Viscous | Law::AsymmetricViscous | Law::Damper => [torque / rate, usual / rate],
            Law::QuadraticDrag => [torque / rate.powi(2), usual / rate.powi(2)],
            Law::SublinearViscous if self.variant == 0 => [torque / rate.sqrt(), usual],
            Law::CoupledFriction if self.variant == 0 => [torque / rate, usual / rate],
            Law::LoadFriction | Law::GearEfficiency => [1.5 * relative, 0.5],
            Law::Capstan => [0.5 * relative, 0.15],
            Law::CouplingInertia => [torque / acceleration, 0.5 * (own * other).sqrt()],
            Law::JointElasticity => [torque / (own * usual * 60.0), 1.0 / (own * 25.0_f64.powi(2))],
            Law::Backlash => [torque / (own * 100.0), 0.06],
            Law::ReturnSpring | Law::HardStop => {
                [torque / (0.2 * shape.reach), 50.0 * usual / shape.reach]
            }
            Law::TorqueGain => [2.0 * relative, 0.5],
            Law::JointZero | Law::BaseTilt => [2.0 * relative, 0.3],
            Law::TransmissionError if self.variant == 0 => [2.0 * relative, 0.5],
            Law::TransmissionError => [relative, 0.05],
            Law::Payload => [torque / 4.0, 4.0],
            Law::LinkInertia => [4.0 * relative, 1.5],
            Law::TorqueDelay => [relative / 4.0, 0.03],
            Law::ActuatorLag => [relative / 4.0, 0.02],
            Law::Saturation => [0.15, 0.5],
            Law::ThermalFriction => [0.3, 0.8],
            Law::ExternalForce => [2.0 * torque, 4.0 * usual],
            _ => [1.5 * torque, 2.0 * usual],
        }
    }
}

impl Generated {
    /// Writes what a diagnosis sees: `model.json`, `train.csv`, `validate.csv`.
    pub fn write_files(&self, folder: &Path) -> io::Result<()> {
        fs::create_dir_all(folder)?;
        fs::write(folder.join("model.json"), format!("{:#}\n", self.case.nominal.file()))?;
        fs::write(folder.join("train.csv"), self.table(&self.train))?;
        fs::write(folder.join("validate.csv"), self.table(&self.validate))
    }

    /// Writes `answer.json`, for nobody to look at before the diagnosis has answered.
    pub fn write_answer(&self, folder: &Path) -> io::Result<()> {
        fs::write(folder.join("answer.json"), format!("{:#}\n", self.answer()))
    }

    fn table(&self, log: &Log) -> String {
        let (joints, recording) = (&self.case.truth.joints, &self.case.recording);
        let named = |prefix: &str, joint: usize| format!("{prefix}_{}", joints[joint].name);
        let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
        for joint in 0..joints.len() {
            columns.push((named("q", joint), log.q[joint].clone()));
            if let Some(rates) = &log.qd {
                columns.push((named("qd", joint), rates[joint].clone()));
            }
            columns.push((named("tau", joint), log.tau[joint].clone()));
            if joints[joint].drive.spring.is_some() {
                let gear = joints[joint].drive.gear;
                let motor = log.motor[joint].iter().map(|angle| gear * angle).collect();
                columns.push((named("motor", joint), motor));
                columns.push((named("tau_cmd", joint), log.tau[joint].clone()));
            }
        }
        let mut text = String::from("t");
        for (name, _) in &columns {
            text.push(',');
            text.push_str(name);
        }
        for row in 0..log.q[0].len() {
            let decimals = if recording.jitter > 0.0 { 7 } else { 5 };
            let _ = write!(text, "\n{:.decimals$}", log.t[row]);
            for (_, column) in &columns {
                text.push(',');
                text.push_str(&recording.digits.cell(column[row]));
            }
        }
        text.push('\n');
        text
    }

    /// What was hidden.
    pub fn answer(&self) -> Value {
        let case = &self.case;
        let expected = match case.plan.kind {
            Kind::Nothing => "nothing",
            Kind::Outside | Kind::CannotTell => "refusal",
            _ => "names",
        };
        let effects: Vec<Value> = case
            .hidden
            .iter()
            .zip(&self.strengths)
            .map(|(hidden, strength)| self.effect(hidden, *strength))
            .collect();
        let mut answer = json!({
            "case": case.number,
            "kind": format!("{:?}", case.plan.kind),
            "robot": ROBOTS[case.plan.robot],
            "nominal_exact": case.plan.exact,
            "expected": expected,
            "strength": STRENGTHS[case.plan.strength].0,
            "filter_hz": CUTOFF_HZ,
            "floor_nm": self.floor[..case.truth.joints.len()],
            "effects": effects,
            "laps_s": [case.references[0].lap_s, case.references[1].lap_s],
        });
        if let Some(condition) = case.plan.condition {
            answer["condition"] = json!({
                "name": format!("{condition:?}"),
                "recording": format!("{:?}", case.recording),
                "resolution": case.sensors.resolution,
                "disturbance_nm": case.disturbance,
                "friction_std": case.nominal.friction_std,
            });
        }
        answer
    }

    fn effect(&self, hidden: &Hidden, strength: f64) -> Value {
        let entry = hidden.law.entry();
        let name = |joint: usize| self.case.truth.joints[joint].name;
        let joints = match entry.site {
            Site::Joint => vec![name(hidden.joint)],
            Site::Pair => vec![name(hidden.joint), name(hidden.other)],
            Site::Link => vec![name(hidden.joint), name(hidden.joint.saturating_sub(1))],
            Site::Model => Vec::new(),
        };
        let same = entry.same.iter().filter(|name| hidden.is_called(name, &self.case.truth));
        let mut parameters = Map::new();
        if hidden.variant == 0 && !entry.parameter.is_empty() {
            let (name, value) = match entry.parameter.strip_prefix('-') {
                Some(name) => (name, -hidden.size),
                None => (entry.parameter, hidden.size),
            };
            parameters.insert(name.to_owned(), json!(value));
        }
        json!({
            "name": entry.name,
            "same_physics": same.collect::<Vec<_>>(),
            "joints": joints,
            "law": format!("{:?}", hidden.law),
            "variant": hidden.variant,
            "size": hidden.size,
            "parameters": parameters,
            "strength_reached": strength,
            "shape": format!("{:?}", hidden.shape),
        })
    }
}
