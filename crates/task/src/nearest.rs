//! Which word somebody meant who mistyped one.

/// Most letters that are wrong, missing, too many, or in each other's place.
const MOST: usize = 2;
/// No word that is known is longer, and comparing takes the product of the lengths.
const LONGEST: usize = 80;

/// The known word that is nearest, where one is near; of short words half at least must be right.
#[must_use]
pub fn nearest<'a>(typed: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if typed.len() > LONGEST {
        return None;
    }
    let typed = typed.to_lowercase();
    let most = MOST.min(typed.chars().count() / 2);
    let away = |word: &str| strsim::damerau_levenshtein(&typed, word);
    known
        .into_iter()
        .map(|word| (away(word), word))
        .filter(|(away, _)| *away <= most)
        .min()
        .map(|(_, word)| word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_letters_may_be_wrong_and_no_more() {
        let known = ["trace", "strokes", "plan", "lab"];
        for (typed, wanted) in [
            ("trcae", Some("trace")),
            ("TRACE", Some("trace")),
            ("trase", Some("trace")),
            ("stroke", Some("strokes")),
            ("plaan", Some("plan")),
            ("ab", Some("lab")),
            ("x", None),
            ("banana", None),
            ("", None),
        ] {
            assert_eq!(nearest(typed, known), wanted, "{typed}");
        }
        assert_eq!(nearest(&"a".repeat(100_000), known), None);
    }
}
