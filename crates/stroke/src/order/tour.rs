/// A closed round through strokes, each entered by one of its two ends: stroke `k` has the ends `2k` and `2k + 1`.
///
/// An open path becomes a round by one more stroke, the depot, that leads from its end "nowhere" (any travel to it
/// costs nothing) to the start point. A round may be read in either sense; ends, not directions, name a move.
#[derive(Clone)]
pub(super) struct Tour {
    /// The end each place of the round is entered by.
    entry: Vec<u32>,
    /// Each stroke's place.
    place: Vec<u32>,
}

impl Tour {
    /// A round through `entry.len()` strokes, each entered by the given end.
    pub(super) fn new(entry: Vec<u32>) -> Self {
        let mut place = vec![0; entry.len()];
        for (i, &end) in entry.iter().enumerate() {
            place[(end >> 1) as usize] = i as u32;
        }
        Self { entry, place }
    }

    pub(super) fn len(&self) -> usize {
        self.entry.len()
    }

    fn place(&self, end: u32) -> usize {
        self.place[(end >> 1) as usize] as usize
    }

    fn before(&self, place: usize) -> usize {
        if place == 0 { self.len() - 1 } else { place - 1 }
    }

    fn after(&self, place: usize) -> usize {
        if place + 1 == self.len() { 0 } else { place + 1 }
    }

    /// Whether the round, read upwards, enters a stroke by this end.
    pub(super) fn enters(&self, end: u32) -> bool {
        self.entry[self.place(end)] == end
    }

    /// The end at the other side of the travel that begins or ends here.
    pub(super) fn link(&self, end: u32) -> u32 {
        let place = self.place(end);
        match self.entry[place] == end {
            true => self.entry[self.before(place)] ^ 1,
            false => self.entry[self.after(place)],
        }
    }

    /// Whether `x` belongs to the run of strokes that begins at `from`, away from its travel, and ends at `to`.
    pub(super) fn is_between(&self, from: u32, x: u32, to: u32) -> bool {
        let (a, b, x) = (self.place(from), self.place(to), self.place(x));
        let (a, b) = if self.entry[a] == from { (a, b) } else { (b, a) };
        if a <= b { a <= x && x <= b } else { x >= a || x <= b }
    }

    /// The far end of the run of `strokes` strokes that begins with `end` and leads away from its travel.
    pub(super) fn far_end(&self, end: u32, strokes: usize) -> u32 {
        (1..strokes).fold(end ^ 1, |far, _| self.link(far) ^ 1)
    }

    /// 2-opt: the travels (u, u') and (v, v') become (u, v) and (u', v'). Both `u` and `v` must be entered, or both
    /// left: the other way of joining them would fall into two rounds.
    pub(super) fn join(&mut self, u: u32, v: u32) {
        let (i, j) = (self.place(u), self.place(v));
        match self.enters(u) {
            true => self.reverse(i, self.before(j)),
            false => self.reverse(self.after(i), j),
        }
    }

    /// Turns around the strokes of the places `from..=to` (around the end), or all the others, which is the same
    /// round: whichever are fewer.
    fn reverse(&mut self, from: usize, to: usize) {
        let n = self.len();
        let count = if to >= from { to - from + 1 } else { to + n - from + 1 };
        match 2 * count <= n {
            true => self.turn(from, to, count),
            false => self.turn(self.after(to), self.before(from), n - count),
        }
    }

    fn turn(&mut self, from: usize, to: usize, count: usize) {
        let (mut a, mut b) = (from, to);
        for _ in 0..count / 2 {
            let (x, y) = (self.entry[b] ^ 1, self.entry[a] ^ 1);
            self.put(a, x);
            self.put(b, y);
            (a, b) = (self.after(a), self.before(b));
        }
        if count % 2 == 1 {
            self.entry[a] ^= 1;
        }
    }

    fn put(&mut self, place: usize, end: u32) {
        self.entry[place] = end;
        self.place[(end >> 1) as usize] = place as u32;
    }

    /// All entries in the order of the round, from a stroke on, read in the sense that enters it by its even end.
    pub(super) fn entries_from(&self, stroke: u32) -> Vec<u32> {
        let first = 2 * stroke;
        std::iter::successors(Some(first), |&entry| Some(self.link(entry ^ 1))).take(self.len()).collect()
    }
}
