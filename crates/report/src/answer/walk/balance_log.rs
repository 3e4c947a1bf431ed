//! Balance row by row: criteria, and events.

use denavit_simulate::{EventKind, Log};
use denavit_walk::balance::{Criterion, Instant};
use denavit_workflow::Judged;

const POINTS: [(&str, Criterion); 4] = [
    ("zmp", Criterion::ZeroMoment),
    ("cart_table", Criterion::CartTable),
    ("fri", Criterion::FootRotation),
    ("capture", Criterion::Capture),
];

/// All criteria, row by row; docs/reference/walking.md lists the columns.
pub fn balance_series(judged: &Judged) -> Log {
    let mut columns = vec!["t".to_owned()];
    let axes = ["x", "y", "z"];
    for vector in ["com", "com_velocity", "com_acceleration", "angular_momentum", "cop"] {
        columns.extend(axes.map(|axis| format!("{vector}_{axis}")));
    }
    for (name, _) in POINTS {
        columns.extend(axes.map(|axis| format!("{name}_{axis}")));
        columns.push(format!("{name}_margin"));
    }
    columns.extend(["support_low", "support_high", "feet", "contacts"].map(str::to_owned));
    let bodies = turning_bodies(judged);
    for body in &bodies {
        let name = &judged.model.joints[*body].name;
        columns.extend(axes.map(|axis| format!("angular_momentum_{name}_{axis}")));
    }
    let mut values = Vec::new();
    for instant in &judged.course.instants {
        values.push(instant.t_s);
        values.extend(instant.center_of_mass.as_flattened());
        values.extend(instant.angular_momentum);
        values.extend(instant.center_of_pressure_m);
        for (_, criterion) in POINTS {
            values.extend(criterion.point(instant).unwrap_or([f64::NAN; 3]));
            values.push(criterion.margin(instant).unwrap_or(f64::NAN));
        }
        values.extend(instant.support.range().unwrap_or([f64::NAN; 2]));
        values.push(feet(instant));
        values.push(instant.closed as f64);
        bodies.iter().for_each(|body| values.extend(instant.body_momenta[*body]));
    }
    let mut header = vec![
        ("denavit", env!("CARGO_PKG_VERSION").to_owned()),
        ("criteria_of", judged.name.clone()),
        ("model", judged.model.name.clone()),
        ("over", judged.course.over.word().to_owned()),
    ];
    header.extend(judged.course.scheme.clone().map(|scheme| ("scheme", scheme)));
    let header = header.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
    Log { header, columns, values }
}

fn feet(instant: &Instant) -> f64 {
    use denavit_walk::balance::Phase;
    match instant.phase {
        Phase::Flight => 0.0,
        Phase::Flat | Phase::Toe => 1.0,
        Phase::Double => 2.0,
    }
}

/// Events with their impulses, and the velocities before and after.
pub fn balance_events(judged: &Judged) -> Log {
    let model = &judged.model;
    let mut columns = ["t", "kind", "energy"].map(str::to_owned).to_vec();
    let points = model.contacts.iter();
    columns.extend(points.clone().map(|contact| format!("closed_{}", contact.name)));
    for contact in points {
        columns.extend(["x", "y", "z"].map(|axis| format!("p_{}_{axis}", contact.name)));
    }
    for prefix in ["q", "qd_before", "qd_after"] {
        columns.extend(model.joints.iter().map(|joint| format!("{prefix}_{}", joint.name)));
    }
    let mut values = Vec::new();
    for event in judged.course.run.iter().flat_map(|run| &run.events) {
        values.push(event.t_s);
        values.push(match event.kind {
            EventKind::Start => 0.0,
            EventKind::Touch(_) => 1.0,
            EventKind::Limit | EventKind::LeastLoads => 2.0,
            EventKind::SlipEnds(_) => 3.0,
            EventKind::Jump(_) => 4.0,
            EventKind::Push => 5.0,
            EventKind::Plan => 6.0,
        });
        values.push(event.energy_j);
        let contacts = 0..model.contacts.len();
        values.extend(contacts.clone().map(|c| f64::from(u8::from(event.closed.contains(&c)))));
        for contact in contacts {
            let hits = event.impulses.iter().filter(|(hit, _)| *hit == contact);
            let sum =
                hits.fold([0.0; 3], |sum, (_, p)| [sum[0] + p[0], sum[1] + p[1], sum[2] + p[2]]);
            values.extend(sum);
        }
        [&event.q, &event.before, &event.after].into_iter().for_each(|part| values.extend(part));
    }
    let kinds = "0 start, 1 touch, 2 limit of forces, 3 end of slipping, 4 jump, 5 push, 6 plan";
    let header = [
        ("denavit".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("events_of".to_owned(), judged.name.clone()),
        ("kinds".to_owned(), kinds.to_owned()),
    ];
    Log { header: header.to_vec(), columns, values }
}

/// The joints whose bodies turn, or go round the centre of mass.
pub(super) fn turning_bodies(judged: &Judged) -> Vec<usize> {
    let turns = |instant: &Instant, body: usize| instant.body_momenta[body] != [0.0; 3];
    let instants = &judged.course.instants;
    let all = 0..judged.model.joints.len();
    all.filter(|body| instants.iter().any(|instant| turns(instant, *body))).collect()
}
