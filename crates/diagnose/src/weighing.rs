//! An effect near values of its parameters, as terms whose evidence can be weighed.

use super::candidate::{Candidate, Start, starts};
use super::data::{Data, ModelTorques, RowResponse};
use super::hypothesis::{Hypothesis, Part};
use super::law::{Law, Motion, OnlyOne, Response};
use super::nominal::Nominal;
use super::signals::Signals;
use super::span::Span;
use super::spectra::Spectra;
use super::state::{Effects, Taken};
use denavit_evidence::{Base, Filtered, Glance, Spectrum, Terms, Unpredicted, policy};
use denavit_measure::JointIndex;
use denavit_numerics::least_and_most;
use denavit_plants::effect::EffectLaw;

/// An effect near values of its parameters, with what is believed of them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Placed {
    /// Its number among the candidates.
    pub(super) candidate: usize,
    /// Where it is linearised.
    pub(super) values: Vec<f64>,
    /// What is believed of its parameters.
    pub(super) center: Vec<f64>,
    /// How far they may be from that.
    pub(super) deviations: Vec<f64>,
    /// The log of the share of its start among all.
    pub(super) log_share: f64,
}

/// Logs, a model and what it is not sure of, in which effects are weighed.
pub(super) struct Weighing<'a> {
    /// Sets of logs.
    pub(super) sets: Vec<&'a Data<'a>>,
    /// What may be missing.
    pub(super) candidates: &'a [Candidate],
    /// What the model has of that.
    pub(super) given: &'a [Taken],
    /// That, and what was found: laws are evaluated beside these.
    present: Vec<Taken>,
    /// Torques of the model along each log of each set.
    pub(super) torques: Vec<Vec<ModelTorques>>,
    pub(super) spectra: Spectra,
    pub(super) base: Base,
    /// The columns of what the model itself is not sure of.
    own: Vec<Spectrum>,
    /// The model's own numbers that torques are those of, in their deviations.
    pub(super) z: Vec<f64>,
    /// Those by which torques above the driven frequency are known.
    fast: Vec<f64>,
    /// Columns of accelerations count below this frequency \[Hz\].
    pub(super) driven_hz: f64,
}

impl<'a> Weighing<'a> {
    /// Sets of logs with the torques of the model's own numbers at z, those above the driven
    /// frequency at `fast`, and the effects that it has; laws are beside these and what was found.
    pub(super) fn new(
        sets: Vec<&'a Data<'a>>,
        effects: Effects<'a>,
        [z, fast]: [&[f64]; 2],
        found: &[Taken],
    ) -> Self {
        let cutoff_hz = sets[0].signals.first().map_or(0.0, |signals| signals.torque_hz);
        let spectra = Spectra::new(&sets, cutoff_hz);
        let logs = sets.iter().flat_map(|data| &data.signals);
        let driven_hz = logs.map(Signals::driven_hz).fold(0.0, f64::max);
        let present = [effects.taken, found].concat();
        let beside = Effects { taken: &present, ..effects };
        let torques = sets.iter().map(|data| data.model_torques(z, beside)).collect();
        let left: Vec<Vec<f64>> = sets.iter().map(|data| data.residual_of(fast)).collect();
        let rows: Vec<&[f64]> = left.iter().map(Vec::as_slice).collect();
        let mut residual = spectra.of_rows(&sets, &rows, f64::INFINITY);
        let mut weighing = Self {
            base: Base::new(spectra.layout.clone(), residual.clone(), &[]),
            own: Vec::new(),
            z: z.to_vec(),
            fast: fast.to_vec(),
            sets,
            candidates: effects.candidates,
            given: effects.taken,
            present,
            torques,
            spectra,
            driven_hz,
        };
        let mut own = weighing.own();
        // What numbers do is known at all frequencies, and how much of it up to some.
        for (column, factor) in own.iter().zip(fast) {
            add(&mut residual, column, *factor);
        }
        for taken in effects.taken {
            let law = weighing.candidates[taken.candidate].law.as_ref();
            let (torque, gradient) = weighing.spectrum(taken);
            add(&mut residual, &torque, -1.0);
            for (mut column, belief) in gradient.into_iter().zip(law.beliefs()) {
                column.iter_mut().flatten().for_each(|entry| *entry *= belief.std);
                own.push(column);
            }
        }
        weighing.move_own(&mut own, &mut residual, found);
        weighing.base = Base::new(weighing.spectra.layout.clone(), residual, &own);
        Self { own, ..weighing }
    }

    /// Lets the columns of the model's own numbers, and the data, be those beside what was found:
    /// an angle turns what bodies do, and a gain scales it.
    fn move_own(&self, own: &mut [Spectrum], data: &mut Spectrum, found: &[Taken]) {
        // transmissions and delays do what was measured
        let is_of_numbers = |taken: &&Taken| {
            let law = &self.candidates[taken.candidate].law;
            !law.is_of_motion() && law.only_one_of().is_none()
        };
        let all: Vec<&Taken> = found.iter().filter(is_of_numbers).collect();
        let here: Vec<Spectrum> = all.iter().map(|taken| self.spectrum(taken).0).collect();
        let numbers = if all.is_empty() { 0 } else { self.sets[0].nominal.len() };
        for (place, column) in own.iter_mut().enumerate().take(numbers) {
            let mut z = self.z.clone();
            z[place] += 1.0;
            let torques = self.torques_at(&z);
            for (taken, here) in all.iter().zip(&here) {
                let mut more = self.spectrum_by(taken, &torques).0;
                add(&mut more, here, -1.0);
                add(column, &more, 1.0);
                add(data, &more, self.z[place]);
            }
        }
    }

    /// The same with other numbers, beside other effects.
    pub(super) fn beside(&self, z: &[f64], found: &[Taken]) -> Self {
        let effects = Effects { candidates: self.candidates, taken: self.given };
        Self::new(self.sets.clone(), effects, [z, z], found)
    }

    /// The same in the same data, so that hypotheses can be compared: what numbers do above the
    /// driven frequency stays as it is.
    pub(super) fn in_same_data(&self, z: &[f64], found: &[Taken]) -> Self {
        let effects = Effects { candidates: self.candidates, taken: self.given };
        Self::new(self.sets.clone(), effects, [z, &self.fast], found)
    }

    /// The model's own numbers by a hypothesis, in their deviations.
    pub(super) fn numbers(&self, hypothesis: &Hypothesis) -> Vec<f64> {
        hypothesis.weighed.own[..self.sets[0].columns.len()].to_vec()
    }

    /// The torques of the model with other numbers, beside the same effects.
    pub(super) fn torques_at(&self, z: &[f64]) -> Vec<Vec<ModelTorques>> {
        let beside = Effects { candidates: self.candidates, taken: &self.present };
        self.sets.iter().map(|data| data.model_torques(z, beside)).collect()
    }

    /// What an effect does more by other torques of the model.
    pub(super) fn change(&self, taken: &Taken, torques: &[Vec<ModelTorques>]) -> Spectrum {
        let mut torque = self.spectrum_by(taken, torques).0;
        add(&mut torque, &self.spectrum(taken).0, -1.0);
        torque
    }

    /// Whether a law does the same whatever the model's numbers are, and what it is beside.
    pub(super) fn is_of_motion(&self, candidate: &Candidate) -> bool {
        let is_same = |torques: &ModelTorques| torques.beside.is_nothing_to(candidate);
        candidate.law.is_of_motion() && self.torques.iter().flatten().all(is_same)
    }

    /// The base without what is too small for a name where one of `parts` does the same, and
    /// without the time between channels where one is the delay of that joint: of two that do the
    /// same nobody could say how large each is.
    pub(super) fn base_beside(&self, parts: &[Part]) -> Base {
        let nominal = self.sets[0].nominal;
        let time = nominal.uncertain.len();
        let (mut own, mut data) = (self.own.clone(), self.base.data.clone());
        for part in parts {
            let law = &self.candidates[part.placed.candidate].law;
            // a late position and a lag by the model are cut where time is, and leave it as it is
            let is_moved = !law.follows_accelerations();
            if let Some((OnlyOne::Lateness, joint)) = law.only_one_of().filter(|_| is_moved) {
                let column = std::mem::take(&mut own[time][joint.0]);
                let whole = self.column(time, f64::INFINITY).swap_remove(joint.0);
                let unseen =
                    whole.iter().zip(&column).map(|(whole, own)| self.fast[time] * (whole - own));
                data[joint.0].iter_mut().zip(unseen).for_each(|(row, unseen)| *row += unseen);
            }
        }
        let spans: Vec<Span> = parts.iter().map(|part| Span::of(&self.spectra, [part])).collect();
        for column in &mut own[time + 1..nominal.place_of_spring(0)] {
            let stacked = self.spectra.stacked(column);
            let little = policy::SAME * stacked.norm();
            if spans.iter().any(|span| span.outside(&stacked).norm() < little) {
                column.clear();
            }
        }
        Base::new(self.spectra.layout.clone(), data, &own)
    }

    /// The columns of the model's own numbers, and of what is between them and the logs.
    fn own(&self) -> Vec<Spectrum> {
        let nominal = self.sets[0].nominal;
        let up_to = |place: usize| self.up_to(follows_accelerations(nominal, place));
        (0..self.sets[0].columns.len()).map(|place| self.column(place, up_to(place))).collect()
    }

    /// One of them, up to a frequency.
    fn column(&self, place: usize, up_to_hz: f64) -> Spectrum {
        let rows = self.sets.iter().map(|data| data.columns[place].as_slice());
        self.spectra.of_rows(&self.sets, &rows.collect::<Vec<_>>(), up_to_hz)
    }

    /// What an effect does to all sets.
    pub(super) fn responses(&self, taken: &Taken) -> Vec<RowResponse> {
        let law = self.candidates[taken.candidate].law.as_ref();
        self.in_rows(&self.torques, &|motion| law.response(motion, &taken.values))
    }

    /// What is given for the motion of each log by torques of the model, in the rows of all sets.
    fn in_rows(
        &self,
        torques: &[Vec<ModelTorques>],
        of: &dyn Fn(Motion<'_>) -> Response,
    ) -> Vec<RowResponse> {
        let sets = self.sets.iter().zip(torques);
        sets.map(|(data, torques)| data.in_rows(of, torques)).collect()
    }

    /// The spectra of an effect's torque and of its gradient.
    pub(super) fn spectrum(&self, taken: &Taken) -> (Spectrum, Vec<Spectrum>) {
        self.spectrum_by(taken, &self.torques)
    }

    fn spectrum_by(
        &self,
        taken: &Taken,
        torques: &[Vec<ModelTorques>],
    ) -> (Spectrum, Vec<Spectrum>) {
        let law = self.candidates[taken.candidate].law.as_ref();
        if !law.is_gain() {
            let up_to_hz = self.up_to(law.follows_accelerations());
            let rows = self.in_rows(torques, &|motion| law.response(motion, &taken.values));
            return self.spectra.of_response(&self.sets, &rows, up_to_hz);
        }
        // in proportion to loads, as far as references drive these, and to friction
        let [asked, rest] = [true, false].map(|is_asked| {
            let rows = self.in_rows(torques, &|motion| {
                let total = motion.part(is_asked);
                law.response(Motion { total: &total, ..motion }, &taken.values)
            });
            self.spectra.of_response(&self.sets, &rows, self.up_to(is_asked))
        });
        let (mut torque, mut gradient) = asked;
        add(&mut torque, &rest.0, 1.0);
        gradient.iter_mut().zip(&rest.1).for_each(|(column, rest)| add(column, rest, 1.0));
        (torque, gradient)
    }

    /// Up to which frequency columns count \[Hz\].
    pub(super) fn up_to(&self, follows_accelerations: bool) -> f64 {
        if follows_accelerations { self.driven_hz } else { f64::INFINITY }
    }

    /// An effect at one of its starts; none if it does nothing there.
    pub(super) fn start(
        &self,
        candidate: usize,
        start: &Start,
        log_share: f64,
    ) -> Option<(Placed, Terms)> {
        let values = start.iter().map(|(value, _)| *value).collect();
        let taken = Taken { candidate, values };
        let (torque, gradient) = self.spectrum(&taken);
        let mut is_felt = self.spectra.largest_share(&torque) > policy::LEAST_FELT;
        let deviation = |(gradient, (_, given)): (&Spectrum, &(f64, Option<f64>))| {
            let share = self.spectra.largest_share(gradient);
            match given {
                Some(deviation) => {
                    is_felt |= share * deviation > policy::LEAST_FELT;
                    *deviation
                }
                None if share > 0.0 && share.is_finite() => {
                    is_felt = true;
                    policy::SIZE / share
                }
                None => 0.0,
            }
        };
        if gradient.len() < start.len() {
            return None;
        }
        let deviations = gradient.iter().zip(start).map(deviation).collect();
        let Taken { candidate, values } = taken;
        let placed = Placed { candidate, center: values.clone(), values, deviations, log_share };
        let terms = self.terms_of(&placed, torque, gradient);
        (is_felt || start.is_empty()).then_some((placed, terms))
    }

    /// Of many starts of an effect that has no amplitude those that do most for the data where they
    /// stand: its derivatives by parameters take several times as long as what it does.
    pub(super) fn nearest(
        &self,
        candidate: usize,
        mut all: Vec<Start>,
        glance: &Glance,
    ) -> Vec<Start> {
        let has_amplitude = |start: &Start| start.iter().any(|(_, given)| given.is_none());
        if all.len() <= policy::STARTS || all.iter().any(has_amplitude) {
            return all;
        }
        let gain = |start: &Start| {
            let values: Vec<f64> = start.iter().map(|(value, _)| *value).collect();
            let law = self.candidates[candidate].law.as_ref();
            let rows = self.in_rows(&self.torques, &|motion| law.torque(motion, &values));
            let up_to_hz = self.up_to(law.follows_accelerations());
            let (known, _) = self.spectra.of_response(&self.sets, &rows, up_to_hz);
            let unpredicted = self.unpredicted(law, &values);
            let filtered = self.filtered(law, &values);
            glance.see(&Terms { known, unpredicted, filtered, ..Terms::default() }).gain
        };
        let mut gains: Vec<(f64, Start)> =
            all.drain(..).map(|start| (gain(&start), start)).collect();
        gains.sort_by(|a, b| b.0.total_cmp(&a.0));
        gains.into_iter().take(policy::STARTS).map(|(_, start)| start).collect()
    }

    /// Where the search of a candidate's parameters begins.
    pub(super) fn starts(&self, candidate: &Candidate) -> Vec<Start> {
        let range = candidate.joint.map(|joint| range(&self.sets, joint));
        let largest = candidate.joint.and_then(|joint| largest(&self.sets, joint));
        starts(candidate.law.parameters(), range, largest, candidate.law.is_of_motion())
    }

    /// An effect where it is placed, with its terms.
    pub(super) fn part(&self, placed: &Placed) -> Part {
        Part { terms: self.terms(placed), placed: placed.clone() }
    }

    /// The terms of an effect where it is placed.
    pub(super) fn terms(&self, placed: &Placed) -> Terms {
        let taken = Taken { candidate: placed.candidate, values: placed.values.clone() };
        let (torque, gradient) = self.spectrum(&taken);
        self.terms_of(placed, torque, gradient)
    }

    fn terms_of(&self, placed: &Placed, known: Spectrum, mut columns: Vec<Spectrum>) -> Terms {
        let law = self.candidates[placed.candidate].law.as_ref();
        let parameters = law.parameters();
        for (column, deviation) in columns.iter_mut().zip(&placed.deviations) {
            column.iter_mut().flatten().for_each(|entry| *entry *= deviation);
        }
        let factor = |by: f64, deviation: &f64| {
            if *deviation > 0.0 { by / deviation } else { by.signum() * f64::INFINITY }
        };
        let all = || placed.values.iter().zip(&placed.deviations);
        let lowest = all()
            .zip(parameters)
            .map(|((value, deviation), parameter)| factor(parameter.bounds[0] - value, deviation));
        let lowest = lowest.map(|one| if one.is_nan() { f64::NEG_INFINITY } else { one });
        let believed = all().zip(&placed.center).map(|((value, deviation), center)| {
            if *deviation > 0.0 { (center - value) / deviation } else { 0.0 }
        });
        Terms {
            known,
            lowest: lowest.collect(),
            is_curved: parameters.iter().map(|parameter| !parameter.linear).collect(),
            believed: believed.collect(),
            unpredicted: self.unpredicted(law, &placed.values),
            filtered: self.filtered(law, &placed.values),
            columns,
        }
    }

    /// The samples of which an effect says nothing.
    fn unpredicted(&self, law: &dyn Law, values: &[f64]) -> Unpredicted {
        let (mut cut, mut squares, mut all) = (0.0, 0.0, 0.0);
        for (data, torques) in self.sets.iter().zip(&self.torques) {
            for (signals, torques) in data.signals.iter().zip(torques) {
                let samples = signals.samples() as f64;
                let motion = torques.motion(data.nominal, signals);
                let Unpredicted { share, left } = law.unpredicted(motion, values);
                cut += samples * share;
                squares += samples * share * left;
                all += samples;
            }
        }
        Unpredicted { share: cut / f64::max(all, 1.0), left: squares / f64::max(cut, 1.0) }
    }

    /// The channel that an effect filters.
    fn filtered(&self, law: &dyn Law, values: &[f64]) -> Vec<Filtered> {
        let of = |(joint, law): (JointIndex, &EffectLaw)| {
            let lines = self.spectra.frequencies(joint.0);
            let log_gain = lines.map(|hz| 0.5 * law.gain(hz, values).ln()).collect();
            let measured = self.spectra.measured[joint.0].clone();
            Filtered { channel: joint.0, measured, log_gain }
        };
        law.following().map(of).into_iter().collect()
    }

    /// What an effect does at the joint where that is most, as a share of its torque.
    pub(super) fn size(&self, taken: &Taken) -> f64 {
        let mut squares = vec![0.0; self.spectra.torque.len()];
        for response in self.responses(taken) {
            for (stretch, torque) in response.stretches.iter().zip(&response.torque) {
                squares[stretch.equation] += torque.iter().map(|row| row * row).sum::<f64>();
            }
        }
        let all = squares.into_iter().enumerate();
        all.map(|(at, squares)| self.spectra.share_of_squares(at, squares)).fold(0.0, f64::max)
    }

    /// The values of the effects that the model has, with own factors.
    pub(super) fn given(&self, own: &[f64]) -> Vec<Taken> {
        let mut factors = own[self.sets[0].columns.len()..].iter();
        let of = |taken: &Taken| {
            let law = &self.candidates[taken.candidate].law;
            let both = taken.values.iter().zip(law.beliefs()).zip(law.parameters());
            let moved = both.map(|((value, belief), parameter)| {
                let [low, high] = parameter.bounds;
                let factor = factors.next().copied().unwrap_or(0.0);
                (value + factor * belief.std).clamp(low.min(*value), high.max(*value))
            });
            Taken { candidate: taken.candidate, values: moved.collect() }
        };
        self.given.iter().map(of).collect()
    }
}

impl Placed {
    /// Values with factors of their deviations, within bounds; curved ones move by a share of the
    /// way, and of one deviation at most.
    pub(super) fn moved(&self, candidates: &[Candidate], factors: &[f64], share: f64) -> Vec<f64> {
        let parameters = candidates[self.candidate].law.parameters().iter();
        let all = self.values.iter().zip(&self.deviations).zip(factors).zip(parameters);
        all.map(|(((value, deviation), factor), parameter)| {
            let [low, high] = parameter.bounds;
            let factor = if parameter.linear { *factor } else { share * factor.clamp(-1.0, 1.0) };
            let by = if *deviation > 0.0 { factor * deviation } else { 0.0 };
            (value + by).clamp(low, high)
        })
        .collect()
    }
}

/// Whether a column of the model is made of accelerations: of bodies, rotors and time.
fn follows_accelerations(nominal: &Nominal<'_>, place: usize) -> bool {
    let bodies = nominal.uncertain.len();
    match nominal.uncertain.get(place) {
        Some(one) => !nominal.is_friction(&one.name),
        // the time between torque and motion
        None => place == bodies,
    }
}

/// Adds so much of a spectrum to another.
pub(super) fn add(to: &mut Spectrum, other: &Spectrum, factor: f64) {
    for (to, other) in to.iter_mut().zip(other) {
        to.iter_mut().zip(other).for_each(|(sum, entry)| *sum += factor * entry);
    }
}

/// The largest measured torque of a joint.
fn largest(sets: &[&Data<'_>], joint: JointIndex) -> Option<f64> {
    let of_set = |data: &&Data<'_>| {
        let logs = data.signals.iter().filter_map(|log| log.measured[joint.0].as_ref());
        logs.flatten().map(|torque| torque.abs()).max_by(f64::total_cmp)
    };
    sets.iter().filter_map(of_set).max_by(f64::total_cmp)
}

/// The least and the largest position of a joint.
pub(super) fn range(sets: &[&Data<'_>], joint: JointIndex) -> [f64; 2] {
    let signals = sets.iter().flat_map(|data| &data.signals);
    least_and_most(signals.flat_map(|signals| signals.q[joint.0].iter()))
}

#[cfg(test)]
#[path = "../tests/unit/weighing.rs"]
mod tests;
