//! Symbols and the classes that say when their value becomes known.

/// What a symbol stands for; the class decides what may be hoisted out of run-time code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SymbolClass {
    /// Joint position q [rad, m].
    Configuration,
    /// Joint rate qd [rad/s, m/s].
    Rate,
    /// Joint acceleration qdd [rad/s^2, m/s^2].
    Acceleration,
    /// Joint torque or force tau [Nm, N], or any other right-hand side.
    Effort,
    /// Time t \[s\].
    Time,
    /// A state of its own that an effect has: the bristle of a friction law, a temperature.
    State,
    /// Lengths, angles, gravity: known constants of the model.
    Geometry,
    /// Masses, first moments and inertias: what is identified.
    Inertia,
    /// Friction, gear ratios, rotor inertias, springs.
    Drive,
}

/// A set of symbol classes: which kinds of symbols an expression depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ClassSet(u16);

impl ClassSet {
    const RUN_TIME: u16 = 0b11_1111;

    /// The set without members: the expression is a constant.
    pub const EMPTY: Self = Self(0);

    /// The set of one class.
    pub const fn of(class: SymbolClass) -> Self {
        Self(1 << class as u8)
    }

    /// The union of two sets.
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether `class` is a member.
    pub const fn contains(self, class: SymbolClass) -> bool {
        self.0 & Self::of(class).0 != 0
    }

    /// Whether there is no member.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether the value may change from one sample to the next; if not, the expression depends on
    /// parameters alone and is computed once.
    pub const fn is_run_time(self) -> bool {
        self.0 & Self::RUN_TIME != 0
    }
}

/// A named symbol. Two symbols of one graph never share a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// The identifier, as it appears in files and emitted code.
    pub name: String,
    /// What the symbol stands for.
    pub class: SymbolClass,
}
