//! Laws of single joints: dry friction, torques without memory, torques with memory.
//!
//! All signs are those of the torque that a drive must give. Sources: Armstrong-Helouvry, Dupont,
//! Canudas de Wit 1994 (Stribeck's curve, stiction); Dahl 1968; Canudas de Wit, Olsson, Astrom,
//! Lischinsky 1995 (LuGre); Iwan 1966 (slip elements); Wen 1976 (hysteretic spring); Euler's belt.

use super::hidden::{Hidden, Law, Shape};
use std::f64::consts::{FRAC_2_PI, TAU};

/// What a law sees at one instant. Angles, rates and loads are those of joints; motors are the
/// drive's side of a transmission in the joint's units.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    pub t: f64,
    pub q: &'a [f64],
    pub qd: &'a [f64],
    pub motor_rate: &'a [f64],
    /// Rigid-body torque of each joint without friction and rotor [N m].
    pub load: &'a [f64],
    /// Coulomb and viscous friction of the plain drive at the joint.
    pub coulomb: &'a [f64],
    pub viscous: &'a [f64],
}

impl Shape {
    /// Where an angle is, in reaches from the middle.
    fn place(&self, q: f64) -> f64 {
        (q - self.middle) / self.reach
    }

    fn other_place(&self, q: f64) -> f64 {
        (q - self.other_middle) / self.other_reach
    }

    /// Angle beyond which a one-sided law acts \[rad\], `share` of the reach from the middle.
    pub fn edge(&self, share: f64) -> f64 {
        self.middle + share * self.reach
    }

    /// Stribeck's rate [rad/s].
    pub fn stribeck_rate(&self) -> f64 {
        (0.1 + 0.15 * self.first) * self.rate
    }

    /// Displacement before slip \[rad\].
    pub fn presliding(&self) -> f64 {
        (0.03 + 0.07 * self.first) * self.reach
    }

    /// Waves per turn.
    fn waves(&self) -> f64 {
        6.0 + (10.0 * self.first).floor()
    }
}

impl Hidden {
    /// Kinetic and breakaway friction that the law adds for a direction of sliding [N m].
    pub fn dry(&self, at: &Moment<'_>, direction: f64, z: &[f64]) -> [f64; 2] {
        let (size, shape, joint) = (self.size, &self.shape, self.joint);
        let rate = at.motor_rate[joint].abs();
        let load = at.load[joint];
        let driving = direction * load > 0.0;
        let same = |level: f64| [level, level];
        match (self.law, self.variant) {
            (Law::Coulomb, 0) => same(size),
            (Law::AsymmetricCoulomb, _) => same(direction * size),
            (Law::Stribeck, variant) => {
                let ratio = rate / shape.stribeck_rate();
                let fall = match variant {
                    0 => (-ratio * ratio).exp(),
                    1 => 1.0 / (1.0 + ratio * ratio),
                    _ => (-ratio).exp(),
                };
                [size * fall, size]
            }
            (Law::Stiction, 0) => [size * (-rate / (0.03 * shape.rate)).exp(), size],
            (Law::Stiction, _) => [0.0, size],
            (Law::LoadFriction, 0) => same(size * load.abs()),
            (Law::LoadFriction, _) => same(size * load.abs().powf(0.8) * shape.torque.powf(0.2)),
            (Law::Capstan, variant) => {
                let place = shape.place(at.q[joint]);
                let bend = if variant == 0 { place } else { 2.0 * place.max(0.0) - 0.5 };
                let wrap = (1.0 + 0.6 * bend).max(0.0) * TAU / 2.0;
                let lost = if driving { (size * wrap).exp_m1() } else { -(-size * wrap).exp_m1() };
                same(lost * load.abs())
            }
            (Law::GearEfficiency, variant) => {
                let share = if driving { 1.0 } else { 0.3 };
                let flat = if variant == 0 { 1.0 } else { 1.5 / (1.0 + load.abs() / shape.torque) };
                same(size * share * flat * load.abs())
            }
            (Law::ThermalFriction, _) => same(-self.warmed(at, z) * at.coulomb[joint]),
            _ => [0.0; 2],
        }
    }

    /// Share of friction that warmth has taken.
    fn warmed(&self, at: &Moment<'_>, z: &[f64]) -> f64 {
        let share = if self.variant == 0 {
            let time_s = 4.0 + 4.0 * self.shape.first;
            -(-at.t.max(0.0) / time_s).exp_m1()
        } else {
            z[0]
        };
        (self.size * share).min(0.95)
    }

    /// Torque without a jump at rest [N m].
    pub fn smooth(&self, at: &Moment<'_>, z: &[f64], dz: &[f64]) -> f64 {
        let (size, shape, joint) = (self.size, &self.shape, self.joint);
        let (v, q) = (at.motor_rate[joint], at.q[joint]);
        let place = shape.place(q);
        let smoothing = 0.2 * shape.rate;
        match (self.law, self.variant) {
            (Law::Coulomb, 1) => size * FRAC_2_PI * (v / (0.01 * shape.rate)).atan(),
            (Law::Viscous, 0) => size * v,
            (Law::Viscous, _) => size * v.signum() * v.abs().powf(0.9) * shape.rate.powf(0.1),
            (Law::SmoothedCoulomb, 0) => size * (v / smoothing).tanh(),
            (Law::SmoothedCoulomb, 1) => size * FRAC_2_PI * (v / smoothing).atan(),
            (Law::SmoothedCoulomb, _) => size * v / v.hypot(smoothing),
            (Law::AsymmetricViscous, 0) => size * v.abs(),
            (Law::AsymmetricViscous, _) => size * (v.hypot(smoothing) - smoothing),
            (Law::QuadraticDrag, 0) => size * v * v.abs(),
            (Law::QuadraticDrag, _) => size * v * v.abs().powf(0.75),
            (Law::SublinearViscous, 0) => size * v.signum() * v.abs().sqrt(),
            (Law::SublinearViscous, _) => size * v / (v.abs() + 0.5 * shape.rate),
            (Law::TorqueOffset, _) => size,
            (Law::HardeningSpring, 0) => size * (0.3 * place + place.powi(3)),
            (Law::HardeningSpring, _) => size * (2.5 * place).sinh() / 6.0,
            (Law::ReturnSpring, 0) => size * (q - shape.edge(0.3 * shape.first)).max(0.0),
            (Law::ReturnSpring, _) => {
                let width = 0.06 * shape.reach;
                size * width * ((q - shape.edge(0.3 * shape.first)) / width).exp().ln_1p()
            }
            (Law::HardStop, variant) => {
                let depth = (q - shape.edge(0.6 + 0.1 * shape.first)).max(0.0);
                let power = if variant == 0 { 1.0 } else { 1.5 };
                let damped = if depth > 0.0 { 0.01 * at.qd[joint] } else { 0.0 };
                size * (depth.powf(power) + damped).max(0.0)
            }
            (Law::Cogging, variant) => {
                let angle = shape.waves() * q + shape.phase;
                let second = if variant == 0 { 0.0 } else { 0.4 * (2.0 * angle + 1.0).cos() };
                size * (angle.cos() + second)
            }
            (Law::ThermalFriction, _) => -self.warmed(at, z) * at.viscous[joint] * v,
            (Law::CoupledFriction, variant) => {
                let sum = v + at.motor_rate[self.other];
                if variant == 0 { size * sum } else { size * (sum / smoothing).tanh() }
            }
            _ => self.unnamed(at, z, place).unwrap_or_else(|| self.remembered(at, z, dz)),
        }
    }

    /// Laws that no catalogue has.
    fn unnamed(&self, at: &Moment<'_>, z: &[f64], place: f64) -> Option<f64> {
        let (size, shape, joint) = (self.size, &self.shape, self.joint);
        let ratio = at.motor_rate[joint] / shape.rate;
        let other = shape.other_place(at.q[self.other]);
        match self.law {
            Law::ProductCoupling => Some(size * place * other),
            Law::PostureDrag => Some(size * ratio * other),
            Law::SineRate => Some(size * (3.0 * at.q[joint]).sin() * ratio * ratio),
            Law::Waveform => {
                let lap = at.t / shape.lap_s;
                let part = |order: f64, phase: f64| (TAU * order * lap + phase).sin();
                let (p, second) = (shape.phase, shape.second * TAU);
                Some(
                    size * (part(7.0, p) + 0.8 * part(11.0, second) + 0.6 * part(17.0, p + second)),
                )
            }
            Law::Chaos => Some(size * z[0] / 8.0),
            Law::Magnet => {
                let place = (place - 0.8 * (shape.first - 0.5)) / 0.15;
                Some(size * place * (-place * place).exp())
            }
            _ => None,
        }
    }

    /// Number of states of the law.
    pub fn states(&self) -> usize {
        match (self.law, self.variant) {
            (Law::Dahl, 1) | (Law::MaxwellSlip, 0) => SLIPS.len(),
            (Law::HystereticSpring, 1) => SLIPS.len(),
            (Law::Dahl | Law::LuGre | Law::MaxwellSlip | Law::HystereticSpring, _) => 1,
            (Law::ThermalFriction, 1) => 1,
            (Law::ActuatorLag, variant) => 1 + variant,
            (Law::Chaos, _) => 3,
            _ => 0,
        }
    }

    /// Rates of the states; lags of actuators are the plant's.
    pub fn rates(&self, at: &Moment<'_>, z: &[f64], dz: &mut [f64]) {
        let (shape, joint) = (&self.shape, self.joint);
        let v = at.motor_rate[joint];
        let width = shape.presliding();
        match (self.law, self.variant) {
            (Law::Dahl, 1) | (Law::MaxwellSlip, 0) | (Law::HystereticSpring, 1) => {
                for ((rate, state), [reach, _]) in dz.iter_mut().zip(z).zip(SLIPS) {
                    let slips = state.abs() >= reach * width && state * v > 0.0;
                    *rate = if slips { 0.0 } else { v };
                }
            }
            (Law::Dahl, _) => dz[0] = v - v.abs() * z[0] / width,
            (Law::MaxwellSlip, _) => {
                // Dahl's law with its exponent 2: softer near slip
                let left = 1.0 - v.signum() * z[0] / width;
                dz[0] = v * left * left.abs();
            }
            (Law::LuGre, variant) => {
                let ratio = v / shape.stribeck_rate();
                let fall =
                    if variant == 0 { (-ratio * ratio).exp() } else { 1.0 / (1.0 + ratio * ratio) };
                dz[0] = v - v.abs() * z[0] / (width * (1.0 + 0.6 * fall));
            }
            (Law::HystereticSpring, _) => {
                let (v, wide) = (at.qd[joint], 2.0 * width);
                dz[0] = v - 0.5 * (v.abs() * z[0] + v * z[0].abs()) / wide;
            }
            (Law::ThermalFriction, 1) => {
                // heat of friction, on the scale of its usual power, leaves with a time constant
                let power = v.abs() / shape.rate;
                let time_s = 4.0 + 4.0 * shape.first;
                dz[0] = if at.t < 0.0 { 0.0 } else { (power - z[0]) / time_s };
            }
            (Law::Chaos, _) => {
                let [x, y, w] = [z[0], z[1], z[2]];
                let pace = 3.0;
                dz[0] = pace * 10.0 * (y - x);
                dz[1] = pace * (x * (28.0 - w) - y);
                dz[2] = pace * (x * y - 8.0 / 3.0 * w);
            }
            _ => {}
        }
    }

    /// States at the start.
    pub fn start(&self, z: &mut [f64], seed: f64) {
        if self.law == Law::Chaos {
            z.copy_from_slice(&[1.0 + seed, 1.0 - seed, 20.0 + 5.0 * seed]);
        }
    }

    /// Torques of laws with states.
    fn remembered(&self, at: &Moment<'_>, z: &[f64], dz: &[f64]) -> f64 {
        let (size, shape) = (self.size, &self.shape);
        let width = shape.presliding();
        let slips = || z.iter().zip(SLIPS).map(|(z, [_, share])| share * z).sum::<f64>() / width;
        match (self.law, self.variant) {
            (Law::Dahl, 1) | (Law::MaxwellSlip, 0) => size * slips(),
            (Law::Dahl | Law::MaxwellSlip, _) => size * z[0] / width,
            (Law::LuGre, _) => size * (z[0] + 0.02 * dz[0]) / width,
            (Law::HystereticSpring, 0) => {
                size * (0.3 * shape.place(at.q[self.joint]) + z[0] / (2.0 * width))
            }
            (Law::HystereticSpring, _) => size * (0.3 * shape.place(at.q[self.joint]) + slips()),
            _ => 0.0,
        }
    }

    /// Whether the torque acts on the drive's side of a transmission.
    pub fn is_on_drive(&self) -> bool {
        !matches!(
            self.law,
            Law::HystereticSpring
                | Law::HardeningSpring
                | Law::ReturnSpring
                | Law::HardStop
                | Law::ProductCoupling
                | Law::Magnet
        )
    }
}

/// Slip elements: reach in units of the presliding displacement, and share of the stiffness, so
/// that all slipping together weigh 1.
const SLIPS: [[f64; 2]; 4] = [[0.4, 0.9], [0.9, 0.35], [1.6, 0.125], [2.5, 0.05]];
