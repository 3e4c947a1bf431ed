//! Files of logs as tables: formats against each other and against bytes laid by hand, topics on
//! one clock, files that are cut or corrupt.
#![cfg(feature = "mcap")]

mod bag;
mod clock;
#[cfg(feature = "parquet")]
mod columnar;
mod damage;
mod hand_laid;
mod made;
mod same_numbers;
#[cfg(feature = "sqlite")]
mod sqlite;
