//! The design matrix: which case a number stands for.
//!
//! Numbers below 1000 are for tuning, those from 1000 to 10999 were run once, and are for
//! tuning since; those from 11000 are reported, once. A number modulo [`ROWS`] is a row of the
//! matrix; everything that the row leaves open is drawn from the number.
//! Rows are dealt out with a stride, so that any thirty numbers in a row are a fair mixture.
//!
//! Numbers from [`CONDITIONS_FROM`] on are rows of a second matrix, of [`CONDITION_ROWS`]: effects
//! and nothing, under each of the [`CONDITIONS`] of real logs. It stands behind the first, whose
//! numbers keep their bytes.

use super::conditions::{CONDITIONS, Condition};
use super::hidden::{Law, TABLE};
use super::robots::ROBOTS;

/// Strengths: how many times what noise leaves at the joint.
pub const STRENGTHS: [(&str, f64); 3] = [("strong", 20.0), ("medium", 6.0), ("weak", 2.0)];

/// What is hidden in a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// One effect of the catalogue's physics.
    Single,
    /// Two at once.
    Pair,
    /// Nothing.
    Nothing,
    /// A law that the catalogue does not have.
    Outside,
    /// Something that no log can show, or that does not repeat.
    CannotTell,
    /// The thesis's own: cable, stick-slip and one-sided spring in the ankle; or no Coriolis terms.
    Thesis,
}

/// A row of the matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    pub kind: Kind,
    pub laws: Vec<Law>,
    /// Which law of the physics, for each.
    pub variants: Vec<usize>,
    /// Number of the robot.
    pub robot: usize,
    /// Index in [`STRENGTHS`].
    pub strength: usize,
    /// Whether the nominal model has the true numbers.
    pub exact: bool,
    /// Whether the robot hardly moves.
    pub still: bool,
    /// What its logs or its model have beside, in the rows behind the first.
    pub condition: Option<Condition>,
}

/// Two effects at once: different joints or different shapes.
const PAIRS: [[Law; 2]; 10] = [
    [Law::Coulomb, Law::Payload],
    [Law::Viscous, Law::Cogging],
    [Law::TorqueOffset, Law::Stribeck],
    [Law::ReturnSpring, Law::Coulomb],
    [Law::RotorInertia, Law::AsymmetricViscous],
    [Law::LoadFriction, Law::BaseTilt],
    [Law::QuadraticDrag, Law::TorqueDelay],
    [Law::HardStop, Law::Viscous],
    [Law::Dahl, Law::HardeningSpring],
    [Law::Coulomb, Law::Viscous],
];

/// What stands outside the catalogue.
const OUTSIDE: [Law; 6] =
    [Law::ProductCoupling, Law::SineRate, Law::Waveform, Law::Chaos, Law::Magnet, Law::PostureDrag];

const REPLICATES: usize = 3;
const NOTHING: usize = 150;
const PAIR_REPLICATES: usize = 2;
const OUTSIDE_REPLICATES: usize = 4;
/// Effects that are hidden alone: all with a name but the one that must be refused.
const SINGLES: usize = 38;

/// Rows by kind, in the order of [`Kind`].
const COUNTS: [usize; 6] = [
    SINGLES * STRENGTHS.len() * REPLICATES,
    PAIRS.len() * PAIR_REPLICATES,
    NOTHING,
    OUTSIDE.len() * OUTSIDE_REPLICATES,
    11,
    4,
];

/// Cases in a full run.
pub const ROWS: usize = COUNTS[0] + COUNTS[1] + COUNTS[2] + COUNTS[3] + COUNTS[4] + COUNTS[5];

/// Has no factor in common with [`ROWS`].
const STRIDE: usize = 197;

/// Robots that can have an effect.
fn robots_for(law: Law) -> &'static [usize] {
    match law {
        Law::Damper => &[5],
        Law::JointElasticity | Law::Backlash => &[0, 1, 2, 3, 4],
        Law::CouplingInertia
        | Law::CoupledFriction
        | Law::ProductCoupling
        | Law::PostureDrag
        | Law::Coriolis => &[1, 2, 3, 4, 5],
        _ => &[0, 1, 2, 3, 4, 5],
    }
}

/// Every third time another law of the same physics, if there is one.
fn variant(law: Law, count: usize) -> usize {
    let variants = law.entry().variants;
    if count % 3 == 2 && variants > 1 { 1 + (count / 3) % (variants - 1) } else { 0 }
}

/// The first number of the rows with conditions of real logs; the first for a run is as far behind
/// it as the run's is behind 0.
pub const CONDITIONS_FROM: u64 = 100_000;
/// Shares of the rows: one for each condition, and three for all of them together, as logs are.
const CONDITION_SHARES: usize = CONDITIONS.len() + 2;
/// In each share, rows with nothing and with one effect.
const CONDITION_COUNTS: [usize; 2] = [4, 4];
/// Rows with conditions.
pub const CONDITION_ROWS: usize = CONDITION_SHARES * (CONDITION_COUNTS[0] + CONDITION_COUNTS[1]);
/// Has no factor in common with [`CONDITION_ROWS`].
const CONDITION_STRIDE: usize = 29;

/// Effects that are hidden alone, in the order of the table.
fn alone(which: usize) -> Law {
    let named =
        TABLE.iter().filter(|entry| !entry.name.is_empty() && entry.law != Law::ExternalForce);
    named.cycle().nth(which).expect("SINGLES laws").law
}

/// The plan of a case.
pub fn plan(number: u64) -> Plan {
    if let Some(number) = number.checked_sub(CONDITIONS_FROM) {
        let rows = CONDITION_ROWS as u64;
        return condition_plan(((number % rows) * CONDITION_STRIDE as u64 % rows) as usize);
    }
    let rows = ROWS as u64;
    let row = ((number % rows) * STRIDE as u64 % rows) as usize;
    row_plan(row)
}

/// A plan whose variants and numbers of the nominal model go with a count.
fn counted(kind: Kind, laws: &[Law], robot: usize, strength: usize, count: usize) -> Plan {
    Plan {
        kind,
        laws: laws.to_vec(),
        variants: laws.iter().map(|law| variant(*law, count)).collect(),
        robot,
        strength,
        exact: count.is_multiple_of(2),
        still: false,
        condition: None,
    }
}

/// One of the robots that can have an effect.
fn choose(law: Law, count: usize) -> usize {
    robots_for(law)[count % robots_for(law).len()]
}

/// A row of the matrix with conditions: each effect once, the first of them twice; strengths and
/// robots go round within a share.
fn condition_plan(row: usize) -> Plan {
    let (which, index) = (row % CONDITION_SHARES, row / CONDITION_SHARES);
    let condition = Some(CONDITIONS[which.min(CONDITIONS.len() - 1)]);
    let exact = (which / 2 + index).is_multiple_of(2);
    let Some(index) = index.checked_sub(CONDITION_COUNTS[0]) else {
        // four of six, a small one always among them
        let robot = (which + index + index.div_ceil(2)) % ROBOTS.len();
        let exact = (which + index).is_multiple_of(2);
        return Plan { exact, condition, ..counted(Kind::Nothing, &[], robot, 0, 0) };
    };
    let count = which + CONDITION_SHARES * index;
    let law = alone(count);
    let (robot, strength) = (choose(law, which + index), (which + index) % STRENGTHS.len());
    Plan { exact, condition, ..counted(Kind::Single, &[law], robot, strength, count) }
}

/// A row of the matrix.
fn row_plan(row: usize) -> Plan {
    let mut index = row;
    let mut part = 0;
    while index >= COUNTS[part] {
        index -= COUNTS[part];
        part += 1;
    }
    match part {
        0 => {
            let (which, rest) = (index / 9, index % 9);
            let (strength, replicate) = (rest / 3, rest % 3);
            let law = alone(which);
            // strength, robot, variant and nominal model must not go in step with each other
            let robot = choose(law, which + 2 * replicate + strength);
            let count = which + replicate + strength;
            let exact = (which + strength + replicate / 2 + replicate).is_multiple_of(2);
            Plan { exact, ..counted(Kind::Single, &[law], robot, strength, count) }
        }
        1 => {
            let laws = PAIRS[index / PAIR_REPLICATES];
            let robot = [1, 2, 3, 4][(index + index / 4) % 4];
            counted(Kind::Pair, &laws, robot, index % 2, index / 2 + index % 2)
        }
        2 => Plan {
            exact: (index / 6).is_multiple_of(2),
            ..counted(Kind::Nothing, &[], index % 6, 0, 0)
        },
        3 => {
            let law = OUTSIDE[index / OUTSIDE_REPLICATES];
            counted(Kind::Outside, &[law], choose(law, index + index / 4), index % 2, index / 2)
        }
        4 if index < 6 => {
            let law = [Law::ExternalForce];
            let variants = vec![index % 2];
            Plan { variants, ..counted(Kind::CannotTell, &law, index, index / 2 % 2, index) }
        }
        4 => {
            let law = [Law::QuadraticDrag, Law::Cogging, Law::AsymmetricViscous][index % 3];
            Plan { still: true, ..counted(Kind::CannotTell, &[law], index - 5, 1, 0) }
        }
        _ if index < 2 => {
            let laws = [Law::Capstan, Law::Stiction, Law::ReturnSpring];
            Plan { exact: index == 0, ..counted(Kind::Thesis, &laws, 5, 0, 0) }
        }
        _ => Plan {
            exact: index == 2,
            ..counted(Kind::Thesis, &[Law::Coriolis], 4 + index % 2, 0, 0)
        },
    }
}
