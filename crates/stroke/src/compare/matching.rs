/// The most pairs that can be made so that each left and each right one is in one pair at most.
///
/// `likes[left]` names the right ones that a left one can be paired with. Augmenting paths: H. W. Kuhn, *The
/// Hungarian method for the assignment problem*, 1955, without weights.
pub(super) fn most_pairs(likes: &[Vec<usize>], rights: usize) -> usize {
    let mut matching = Matching { likes, left_of: vec![None; rights], seen: vec![0; rights] };
    (1..).zip(0..likes.len()).filter(|&(round, left)| matching.place(left, round)).count()
}

struct Matching<'a> {
    likes: &'a [Vec<usize>],
    /// The left one that a right one is paired with.
    left_of: Vec<Option<usize>>,
    /// The last round in which a right one was asked.
    seen: Vec<usize>,
}

impl Matching<'_> {
    /// Finds a right one for `left`, moving others on if need be. As deep as pairs can be moved on: each right one
    /// is asked once a round.
    fn place(&mut self, left: usize, round: usize) -> bool {
        let likes = self.likes;
        likes[left].iter().any(|&right| {
            if self.seen[right] == round {
                return false;
            }
            self.seen[right] = round;
            let free = self.left_of[right].is_none_or(|other| self.place(other, round));
            if free {
                self.left_of[right] = Some(left);
            }
            free
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_moves_on_to_make_room_for_another() {
        assert_eq!(most_pairs(&[vec![0, 1], vec![0]], 2), 2);
        assert_eq!(most_pairs(&[vec![0, 1], vec![0, 2], vec![0], vec![2]], 3), 3);
    }

    #[test]
    fn two_cannot_share_one() {
        assert_eq!(most_pairs(&[vec![0], vec![0]], 1), 1);
        assert_eq!(most_pairs(&[vec![], vec![]], 1), 0);
    }
}
