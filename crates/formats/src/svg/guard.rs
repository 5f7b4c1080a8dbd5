//! What a small SVG could swell to or keep busy for, judged before it does.

use std::collections::HashMap;

use usvg::roxmltree::{Document, Node, NodeId};

use crate::FormatError;
use crate::svg::swell;
use crate::svg::tags::Tags;

/// Nesting of elements. `usvg` walks the tree by recursion, some kilobytes of stack a level.
const MAX_DEPTH: usize = 128;

/// Attribute text of all elements, each `use` counted with what it shows, bytes. Two bytes are a path segment at
/// most, a segment some tens of bytes in memory.
const MAX_EXPANDED: u64 = 20 << 20;

/// Attributes of one tag, namespaces among them: each is compared with all others. Drawing programs write some thirty.
const MAX_ATTRIBUTES: usize = 256;

/// Namespaces in scope at once. Drawing programs declare a dozen.
const MAX_NAMESPACES: usize = 256;

/// Comparisons of namespaces, half a second of them: a dozen declared anew by each of 500 000 groups.
const MAX_SCOPING: u64 = 100_000_000;

/// Rules of style sheets held against elements, a second or two of them: 600 rules for each of 100 000 elements.
const MAX_STYLING: u64 = 60_000_000;

/// Bytes that elements keep of the style sheet's declarations.
const MAX_STYLES: u64 = 256 << 20;

/// Elements, before anything is made of them: each is a node, and the space before it another.
const MAX_TAGS: usize = 1_000_000;

/// Tags that stand in entities, each counted as often as any entity is named.
const MAX_ENTITY_TAGS: usize = 10_000;

/// Refuses a text of which a tree would take far longer to build than the text to read.
///
/// # Errors
/// What there is too much of, how much, and the bound.
pub(super) fn check_text(text: &str) -> Result<(), FormatError> {
    let entities = entities(text)?;
    let mut tags = Tags::of(text);
    check_entities(text, &entities, &mut tags)?;
    within("SVG", [tags.elements, MAX_TAGS], "elements")?;
    within("SVG's nesting", [tags.depth, MAX_DEPTH], "levels")?;
    within("SVG's longest tag", [tags.attributes, MAX_ATTRIBUTES], "attributes")?;
    within("SVG's innermost element", [tags.in_scope, MAX_NAMESPACES], "namespaces")?;
    within("SVG", [size(tags.scoping), size(MAX_SCOPING)], "namespaces times namespaces in scope")?;
    let work = tags.style.work(&entities, tags.depth);
    let styling = work.rules.saturating_mul(tags.looks);
    within("SVG's style sheet", [size(styling), size(MAX_STYLING)], "rules times elements")?;
    let kept = work.kept.saturating_mul(tags.elements as u64);
    within("SVG's style sheet", [size(kept), size(MAX_STYLES)], "bytes of declarations times elements")
}

fn within(what: &'static str, [found, limit]: [usize; 2], unit: &'static str) -> Result<(), FormatError> {
    if found <= limit { Ok(()) } else { Err(FormatError::TooLarge { what, found, unit, limit }) }
}

fn size(count: u64) -> usize {
    usize::try_from(count).unwrap_or(usize::MAX)
}

/// The names and texts that a document declares.
fn entities(text: &str) -> Result<HashMap<&str, &str>, FormatError> {
    let mut declared = HashMap::new();
    for declaration in text.split("<!ENTITY").skip(1) {
        let (name, rest) = declaration.trim_start().split_once(char::is_whitespace).unwrap_or_default();
        let value = rest.find(['"', '\'']).and_then(|at| {
            let quote = char::from(rest.as_bytes()[at]);
            rest[at + 1..].split_once(quote).map(|(value, _)| value)
        });
        let value = value.unwrap_or_default();
        if name.contains('%') || value.contains(['&', '%']) {
            return Err(FormatError::Refused { what: "an entity that names another one", instead: PLAIN });
        }
        if value.contains("<style") || value.contains(":style") {
            return Err(FormatError::Refused { what: "an entity that holds a style sheet", instead: PLAIN });
        }
        declared.insert(name, value);
    }
    Ok(declared)
}

const PLAIN: &str = "save the SVG without a DOCTYPE (\"plain SVG\")";

/// Refuses entities that could be a bomb, long and often used ones, and counts the tags in them. What drawing programs
/// write, short names of namespaces, passes.
fn check_entities(text: &str, entities: &HashMap<&str, &str>, tags: &mut Tags) -> Result<(), FormatError> {
    let longest = entities.values().map(|value| value.len()).max().unwrap_or(0);
    let uses = if longest == 0 { 0 } else { text.matches('&').count() };
    within(
        "SVG's entities",
        [uses.saturating_mul(longest), size(MAX_EXPANDED)],
        "bytes where they are used",
    )?;
    let outside = tags.depth;
    for value in entities.values().filter(|value| value.contains('<')) {
        let inside = Tags::of(value);
        let repeated = inside.elements.saturating_mul(uses);
        within("SVG's entities", [repeated, MAX_ENTITY_TAGS], "tags where they are used")?;
        tags.elements += repeated;
        tags.looks += inside.looks.saturating_mul(uses as u64);
        tags.depth = tags.depth.max(outside + inside.depth);
        tags.attributes = tags.attributes.max(inside.attributes);
        tags.in_scope += inside.in_scope;
        tags.scoping = tags.scoping.saturating_add(inside.scoping.saturating_mul(uses as u64));
    }
    Ok(())
}

/// Refuses a tree that is too deep or, its `use` elements followed and its markers repeated, too large.
pub(super) fn check_tree(document: &Document) -> Result<(), FormatError> {
    within("SVG's nesting", [deepest(document), MAX_DEPTH], "levels")?;
    check_style_sheets(document)?;
    let mut weights = Weights::of(document);
    let weight = weights.element(document.root_element(), 0).saturating_mul(weights.markers(document));
    if weight <= MAX_EXPANDED {
        return Ok(());
    }
    // rather what swells by itself than what is repeated
    let round =
        document.descendants().map(|n| swell::weight(n, weights.largest)).fold(0, u64::saturating_add);
    let [bound, all] = [size(MAX_EXPANDED), size(weight)];
    within("SVG, its arcs and ellipses made cubics,", [size(round), bound], "bytes of attributes")?;
    within("SVG, what it repeats counted each time,", [all, bound], "bytes of attributes")
}

fn deepest(document: &Document) -> usize {
    let mut depths = HashMap::new();
    let mut deepest = 0;
    // document order: a parent comes before its children
    for node in document.descendants() {
        let above = node.parent().and_then(|p| depths.get(&p.id()).copied()).unwrap_or(0);
        depths.insert(node.id(), above + 1);
        deepest = deepest.max(above + 1);
    }
    deepest
}

/// Elements that others may refer to from a style sheet, at most: chains of them are followed by recursion too, and
/// style sheets are not looked into here.
const MAX_STYLED: usize = 128;

fn check_style_sheets(document: &Document) -> Result<(), FormatError> {
    let in_style = |n: &Node| n.parent().is_some_and(|p| p.tag_name().name() == "style");
    let refers = document.descendants().any(|n| in_style(&n) && n.text().is_some_and(|t| t.contains("url(")));
    let shared = ["pattern", "clipPath", "mask", "marker", "filter"];
    let found = document.descendants().filter(|n| shared.contains(&n.tag_name().name())).count();
    let counted = if refers { found } else { 0 };
    within(
        "SVG, which refers from its style sheet,",
        [counted, MAX_STYLED],
        "patterns, clips, masks, markers and filters",
    )
}

/// The address in the rest of a `url(`, with or without quotes.
fn unquoted(rest: &str) -> &str {
    let address = rest.split(')').next().unwrap_or_default();
    address.trim_matches(|c: char| c.is_whitespace() || c == '"' || c == '\'')
}

/// How many bytes of attributes each element stands for, what round things swell to included.
struct Weights<'a> {
    by_id: HashMap<&'a str, Node<'a, 'a>>,
    known: HashMap<NodeId, u64>,
    /// See [`swell::largest_size`].
    largest: f64,
    /// An element shows another one's text.
    has_tref: bool,
}

impl<'a> Weights<'a> {
    fn of(document: &'a Document<'a>) -> Self {
        let has_tref = document.descendants().any(|n| n.tag_name().name() == "tref");
        let named = document.descendants().filter_map(|n| n.attribute("id").map(|id| (id, n)));
        Self {
            by_id: named.collect(),
            known: HashMap::new(),
            largest: swell::largest_size(document),
            has_tref,
        }
    }

    /// Of the element, its children, and whatever it shows by reference. References are followed as deep as the
    /// tree may be; deeper ones, and circles, weigh too much.
    fn element(&mut self, node: Node<'a, 'a>, depth: usize) -> u64 {
        if depth > MAX_DEPTH {
            return u64::MAX;
        }
        if let Some(&weight) = self.known.get(&node.id()) {
            return weight;
        }
        // an element takes memory without attributes too
        let mut weight = 16 + node.attributes().map(|a| a.value().len() as u64).sum::<u64>();
        weight = weight.saturating_add(swell::weight(node, self.largest));
        weight = weight.saturating_add(self.letters(node));
        let children: Vec<_> = node.children().filter(Node::is_element).collect();
        for part in children.into_iter().chain(self.shown_by(node)) {
            // enough is enough: two groups of many uses of each other would take for ever to weigh
            if weight <= MAX_EXPANDED {
                weight = weight.saturating_add(self.element(part, depth + 1));
            }
        }
        self.known.insert(node.id(), weight);
        weight
    }

    /// Of the letters that stand in an element: each becomes an outline of some tens of segments.
    fn letters(&self, node: Node) -> u64 {
        const OF_LETTER: u64 = 100;
        // any element's text may be shown by a `tref`
        let is_shown =
            self.has_tref || matches!(node.tag_name().name(), "text" | "tspan" | "textPath" | "a" | "tref");
        let texts =
            node.children().filter(|child| is_shown && child.is_text()).filter_map(|child| child.text());
        texts.map(|text| text.split_whitespace().map(|word| word.len() as u64).sum::<u64>()).sum::<u64>()
            * OF_LETTER
    }

    /// What an element refers to: by `href`, and by `url(#…)` in any attribute (patterns, clips, masks, markers).
    fn shown_by(&self, node: Node<'a, 'a>) -> Vec<Node<'a, 'a>> {
        let links = node.attributes().flat_map(|a| {
            let whole = (a.name() == "href").then(|| a.value().trim());
            whole.into_iter().chain(a.value().split("url(").skip(1).map(unquoted))
        });
        links.filter_map(|link| self.by_id.get(link.strip_prefix('#')?).copied()).collect()
    }

    /// How often a marker's weight may come on top of a path's: a marker is drawn at every vertex, so each byte of
    /// a path may stand for the heaviest one.
    fn markers(&mut self, document: &'a Document<'a>) -> u64 {
        let markers = document.descendants().filter(|n| n.tag_name().name() == "marker");
        1 + markers.map(|m| self.element(m, 0)).max().map_or(0, |heaviest| heaviest / 16)
    }
}
