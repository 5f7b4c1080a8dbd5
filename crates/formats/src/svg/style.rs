//! How much work a style sheet is: each of its rules is held against each element.

use std::borrow::Cow;
use std::collections::HashMap;

/// The style sheets of a text.
#[derive(Default)]
pub(super) struct Style<'a> {
    texts: Vec<&'a str>,
}

/// What whoever resolves a style sheet has to do for each element.
#[derive(Debug, PartialEq)]
pub(super) struct Work {
    /// Rules that are held against it; one that looks at the elements around counts for more.
    pub(super) rules: u64,
    /// Bytes of declarations that it may keep.
    pub(super) kept: u64,
}

/// Elements around one of them that a rule looks at while it takes another rule's time.
const LOOKS_OF_RULE: u64 = 8;

impl<'a> Style<'a> {
    /// A piece of text within a style sheet.
    pub(super) fn add(&mut self, text: &'a str) {
        self.texts.push(text);
    }

    /// For each element of a tree of that depth; `entities` are the names and texts that the document declares.
    pub(super) fn work(&self, entities: &HashMap<&str, &str>, depth: usize) -> Work {
        let whole: String = self.texts.iter().map(|text| resolved(text, entities)).collect();
        let bare = without(&whole, "/*", "*/");
        // where brackets stand in the quotes of a selector, and where they are taken for a mistake and passed over
        let [quoted, raw] = [&without_quotes(&bare), &bare].map(|css| of_rules(css, depth));
        Work { rules: quoted.rules.max(raw.rules), kept: quoted.kept.max(raw.kept) }
    }
}

/// Of a style sheet without comments. A block ends as early as it can: what follows is held for a rule rather than not.
fn of_rules(css: &str, depth: usize) -> Work {
    let mut longest: HashMap<&str, u64> = HashMap::new();
    let mut rules = 0_u64;
    let mut selectors = None;
    for part in css.split_inclusive(['{', '}']) {
        if let Some(open) = part.strip_suffix('{') {
            selectors = open.rsplit(';').next();
            continue;
        }
        let Some(selectors) = selectors.take() else { continue };
        // no such rules are applied: fonts, and what depends on the medium
        if selectors.trim_start().starts_with('@') {
            continue;
        }
        let each = selectors.split(',').map(|s| looks(s, depth)).fold(0, u64::saturating_add);
        rules = rules.saturating_add(each);
        for (name, value) in part.trim_end_matches('}').split(';').filter_map(|d| d.split_once(':')) {
            let held = longest.entry(name.trim()).or_default();
            *held = (*held).max(value.len() as u64);
        }
    }
    Work { rules, kept: longest.values().sum() }
}

/// A text without what stands between two marks, and without them.
fn without(text: &str, open: &str, close: &str) -> String {
    let mut pieces = text.split(open);
    let mut left = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        left.push(' ');
        left.push_str(piece.split_once(close).map_or("", |(_, rest)| rest));
    }
    left
}

/// A text without what stands in quotes right behind a `=`, as in `[class="a"]`.
fn without_quotes(css: &str) -> String {
    let mut left = String::with_capacity(css.len());
    let mut rest = css;
    while let Some((before, behind)) = rest.split_once('=') {
        left.push_str(before);
        rest = match behind.chars().next() {
            Some(quote @ ('"' | '\'')) => behind[1..].split_once(quote).map_or("", |(_, behind)| behind),
            _ => {
                left.push('=');
                behind
            }
        };
    }
    left.push_str(rest);
    left
}

/// How often a selector looks at an element or one around it, at worst, in rules: at every choice of as many elements
/// above as it has words.
fn looks(selector: &str, depth: usize) -> u64 {
    let above = selector.split(|c: char| c.is_whitespace() || c == '>' || c == '+').filter(|w| !w.is_empty());
    let steps = above.count().saturating_sub(1).min(depth / 2);
    let mut ways = 1.0;
    for step in 0..steps {
        ways *= (depth - step) as f64 / (step + 1) as f64;
    }
    1 + ways as u64 / LOOKS_OF_RULE
}

/// With entities and numbered characters put in, as a parser will: braces may hide behind them.
fn resolved<'a>(text: &'a str, entities: &HashMap<&str, &str>) -> Cow<'a, str> {
    if !text.contains('&') {
        return Cow::Borrowed(text);
    }
    let mut parts = text.split('&');
    let mut whole = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once(';').unwrap_or(("", part));
        match name.strip_prefix('#') {
            Some(number) => whole.extend(numbered(number)),
            None => whole.push_str(entities.get(name).copied().unwrap_or_default()),
        }
        whole.push_str(rest);
    }
    Cow::Owned(whole)
}

fn numbered(number: &str) -> Option<char> {
    let code = match number.strip_prefix('x') {
        Some(hex) => u32::from_str_radix(hex, 16),
        None => number.parse(),
    };
    char::from_u32(code.ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn work(css: &str) -> Work {
        let mut style = Style::default();
        style.add(css);
        style.work(&HashMap::from([("rule", "a{fill:red}")]), 10)
    }

    #[test]
    fn a_rule_counts_for_each_of_its_selectors_and_for_what_lies_above() {
        assert_eq!(work("a{fill:red}"), Work { rules: 1, kept: 3 });
        assert_eq!(work("a,.b{fill:red;stroke:none} c {fill:green}"), Work { rules: 3, kept: 9 });
        assert_eq!(work("g path{fill:red}").rules, 2, "10 ancestors are an eighth of a rule each");
        assert_eq!(work("g g g path{fill:red}").rules, 1 + 120 / 8);
        assert_eq!(work("").rules, 0);
        assert_eq!(work("@font-face{src:url(x)}@import 'y';a{fill:red}"), Work { rules: 1, kept: 3 });
        assert_eq!(work("g /*}*/ g g path{fill:red}").rules, 1 + 120 / 8, "a comment hides nothing");
        assert_eq!(work("g[a='}{'] g g path{fill:red}").rules, 1 + 120 / 8, "nor do quotes");
    }

    #[test]
    fn a_style_sheet_full_of_quotes_takes_no_time() {
        let started = std::time::Instant::now();
        assert_eq!(work(&"[a=\"\"]".repeat(400_000)).rules, 0);
        assert!(started.elapsed().as_secs_f64() < 1.0, "{:?}", started.elapsed());
    }

    #[test]
    fn what_hides_behind_entities_counts_too() {
        assert_eq!(work("&rule;&rule;").rules, 2);
        assert_eq!(work("a&#123;fill:red&#x7d;b{fill:red}").rules, 2);
    }
}
