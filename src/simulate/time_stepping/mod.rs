//! Schemes that take contacts into account over whole steps, impacts and forces alike.
