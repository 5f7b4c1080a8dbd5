/// Edges of a quadrature encoder repeat after four: two lines, two edges each.
const PHASES: usize = 4;
/// What is left of a misplacement once it is known: friction's ripple and the tick's own errors, counts.
const FLOOR_COUNTS: f32 = 0.02;

/// How far the four kinds of edges lie from where they should, learned while they pass.
///
/// The two lines of an encoder are never quite a quarter apart nor high for quite a half, the same all the way round
/// (Merry, van de Molengraft & Steinbuch, *Velocity and acceleration estimation for optical incremental encoders*,
/// Mechatronics 20, 2010). What is common to all four is a turn of the whole disc, which nothing here can tell: the
/// table's mean stays zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeTable {
    offset_counts: [f32; PHASES],
    variance: [f32; PHASES],
}

impl EdgeTable {
    /// They are about there, counts, and may be off by that deviation.
    pub(super) const fn about(offset_counts: [f32; PHASES], deviation_counts: f32) -> Self {
        Self { offset_counts, variance: [deviation_counts * deviation_counts; PHASES] }
    }

    /// Where an edge lies, counts from its place, and the variance of that, counts². `edge` numbers the count above it.
    pub(super) const fn place(&self, edge: i32) -> (f32, f32) {
        let phase = edge.rem_euclid(PHASES as i32) as usize % PHASES;
        (self.offset_counts[phase], self.variance[phase] + FLOOR_COUNTS * FLOOR_COUNTS)
    }

    /// An edge was taken to be `ahead_counts` further on than the joint was when it came, by a filter whose innovation has
    /// this variance, counts²; a share of both is the edge's own (Kalman's update of a state that the rest does not know).
    pub(super) fn learn(&mut self, edge: i32, ahead_counts: f32, variance: f32) {
        let phase = edge.rem_euclid(PHASES as i32) as usize % PHASES;
        let gain = self.variance[phase] / variance;
        self.offset_counts[phase] -= gain * ahead_counts;
        self.variance[phase] -= gain * self.variance[phase];
        let mean = self.offset_counts.iter().sum::<f32>() / PHASES as f32;
        for offset in &mut self.offset_counts {
            *offset -= mean;
        }
    }
}
