//! Tests of the whole: the command, what crosses packages, and the tidiness of the tree.

mod blind_battery;
mod blind_conditions;
mod cli;
mod gait;
mod tidy;
