//! Springs, motors and load, as tables of text.

use super::identified::{parameter_table, write_nearest};
use crate::{Align, Table, percent, short};
use denavit_elastic::Estimate;
use denavit_workflow::TwoStageFound;
use std::fmt::{self, Write};

/// Springs, motors and load, as tables of text.
pub fn two_stage_text(found: &TwoStageFound) -> String {
    let mut out = String::new();
    write(&mut out, found).expect("text has room");
    out
}

fn write(out: &mut String, found: &TwoStageFound) -> fmt::Result {
    for remark in &found.remarks {
        writeln!(out, "{remark}")?;
    }
    if !found.remarks.is_empty() {
        writeln!(out)?;
    }
    writeln!(out, "{}: springs and motors, then the load\n", found.model.model)?;
    let mut table = columns(&["joint", "", "value", "std", "unit", "equation misses"]);
    for spring in &found.stages.springs {
        let rows = [
            ("stiffness", spring.stiffness, "N/m"),
            ("viscous", spring.viscous, "N m s/rad"),
            ("Coulomb", spring.coulomb, "N m"),
            ("motor's zero", spring.motor_zero, "rad"),
        ];
        for (at, (what, Estimate { value, std }, unit)) in rows.into_iter().enumerate() {
            let missed = match at {
                0 => format!("{:.2} %", 100.0 * spring.residual / spring.torque.max(1e-300)),
                _ => String::new(),
            };
            let joint = if at == 0 { spring.joint.clone() } else { String::new() };
            let (what, unit) = (what.to_owned(), unit.to_owned());
            table.push(vec![joint, what, short(value), format!("{std:.1e}"), unit, missed]);
        }
    }
    writeln!(out, "{table}")?;
    writeln!(out, "{}", parameter_table(&found.parameters))?;
    let mut table = columns(&["joint", "torque", "residual", "held out"]);
    for (joint, [missed, size]) in found.model.joints.iter().zip(&found.stages.residuals) {
        let other = found.left_of(&joint.name).map(percent).unwrap_or_default();
        table.push(vec![joint.name.clone(), short(*size), short(*missed), other]);
    }
    write!(out, "{}", table.without_empty_columns())?;
    write_nearest(out, found.bodies.distance)
}

fn columns(names: &[&str]) -> Table {
    let is_text = ["joint", "", "unit"];
    let align = |name: &str| if is_text.contains(&name) { Align::Left } else { Align::Right };
    let columns: Vec<(&str, Align)> = names.iter().map(|name| (*name, align(name))).collect();
    Table::new(&columns)
}
