//! What the check of a certificate found.

use denavit_codegen::regressor::{Certificate, ParameterGroup, Verdict};
use serde::Serialize;

#[derive(Serialize)]
struct VerdictJson<'a> {
    model: &'a str,
    verified: bool,
    /// The number of base parameters.
    rank: Option<usize>,
    /// Whether each relation was also written out in every torque.
    multiplied_out: bool,
    /// What it is about: bodies, friction, ..
    about: Vec<&'static str>,
    verdict: String,
}

/// For people: the verdict on a model's certificate, and what that is about.
pub fn verdict_text(model: &str, certificate: &Certificate, verdict: &Verdict) -> String {
    format!("{model}: {verdict}\nabout: {}\n", about(certificate).join(", "))
}

/// The same as a JSON document.
pub fn verdict_json<'a>(
    model: &'a str,
    certificate: &Certificate,
    verdict: &Verdict,
) -> impl Serialize + use<'a> {
    let (rank, multiplied_out) = match *verdict {
        Verdict::Verified { rank, multiplied_out } => (Some(rank), multiplied_out),
        _ => (None, false),
    };
    let (verified, about) = (verdict.is_verified(), about(certificate));
    VerdictJson { model, verified, rank, multiplied_out, about, verdict: verdict.to_string() }
}

fn about(certificate: &Certificate) -> Vec<&'static str> {
    certificate.about().into_iter().map(ParameterGroup::as_str).collect()
}
