//! The robot of a diagnosis as it moved, with what was found marked.

use super::super::html::{Part, SceneMark, Section};
use super::super::jointed::JointMotion;
use super::{DiagnosisPage, rough};

/// What the signs of torques stand for.
fn signs([most_nm, most_n]: [f64; 2]) -> String {
    let turned = (most_nm > 0.0).then(|| {
        format!(
            "Arcs about the joints are the residuals of models: three quarters of a turn are {} N \
             m. ",
            rough(most_nm)
        )
    });
    let slid = (most_n > 0.0)
        .then(|| format!("Bars beside sliding joints: the longest is {} N. ", rough(most_n)));
    [turned, slid].into_iter().flatten().collect()
}

impl DiagnosisPage<'_> {
    /// The robot along a held-out log, with the joints and the bodies of the effects marked; of the
    /// joint that leaves most where nothing was found.
    pub(super) fn robot(&self) -> Option<Section> {
        let scene = self.scene.as_ref()?;
        let found = self.found;
        let most = self.torque_curves().first().map(|(_, curve)| curve.file.as_str());
        let own = found.logged.iter().find(|log| Some(log.file.as_str()) == most);
        let log = own.or_else(|| found.logged.first())?;
        let columns = self.joints.iter().copied().zip(log.q.iter().map(Vec::as_slice));
        let own = found.curves.iter().filter(|curve| curve.file == log.file);
        let left = own.map(|curve| (curve.at.as_str(), [&curve.as_given[..], &curve.after[..]]));
        let left = left.collect();
        let motion = JointMotion { t_s: &log.t_s, q: columns.collect(), beside: None, left };
        let (mut scene, mut marks) = (scene.clone(), Vec::new());
        for one in &found.effects {
            let (with_mark, words) = self.marked(&scene, one);
            marks.extend(words);
            scene = with_mark;
        }
        if let Some(worst) = found.before.first().filter(|_| marks.is_empty()) {
            scene = scene.marking(&[worst.joint.as_str()], false);
            let word = format!("{}: the largest residual", worst.joint);
            marks.push(SceneMark::marked(word));
        }
        let name = format!("{} along {}, in three dimensions", self.model, log.file);
        let caption = format!(
            "The motion of {}, as it was measured: nothing is simulated here. Marked in red: where \
             the effects act. {}Drag to turn, scroll to come closer.",
            log.file,
            signs(scene.most_left(&motion))
        );
        let words = ["residual of the model as it was given", "with the effects"];
        marks.extend(SceneMark::left(words));
        let played = scene.moving([name, caption], marks, &motion)?;
        let parts = vec![Part::Replay(played)];
        Some(Section { heading: "Where on the robot".to_owned(), parts })
    }
}
