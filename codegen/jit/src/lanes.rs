//! How many samples machine code computes at once.

/// Samples that a batch computes side by side: those of one register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Lanes {
    /// Two: what one register of every 64-bit processor holds.
    Two,
    /// Four, in the 256 bits of AVX2; fused products are needed, too.
    Four,
    /// Eight, in the 512 bits of AVX-512F.
    Eight,
}

impl Lanes {
    /// All, the narrowest first.
    pub const ALL: [Self; 3] = [Self::Two, Self::Four, Self::Eight];

    /// The number of samples.
    pub const fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Four => 4,
            Self::Eight => 8,
        }
    }

    /// Whether this processor has registers and instructions for so many; it is asked at run time.
    #[cfg(target_arch = "x86_64")]
    pub fn is_available(self) -> bool {
        match self {
            Self::Two => true,
            Self::Four => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            Self::Eight => is_x86_feature_detected!("avx512f"),
        }
    }

    /// Whether this processor has registers and instructions for so many; it is asked at run time.
    #[cfg(not(target_arch = "x86_64"))]
    pub fn is_available(self) -> bool {
        self == Self::Two
    }

    /// As many as this processor has.
    pub fn widest() -> Self {
        let all = Self::ALL.into_iter().rev();
        { all }.find(|lanes| lanes.is_available()).unwrap_or(Self::Two)
    }
}
