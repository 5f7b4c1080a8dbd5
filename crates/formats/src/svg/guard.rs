//! What a small SVG could swell to, judged before it does.

use std::collections::HashMap;

use usvg::roxmltree::{Document, Node, NodeId};

use super::swell;
use crate::FormatError;

/// Nesting of elements. `usvg` walks the tree by recursion, some kilobytes of stack a level.
const MAX_DEPTH: usize = 128;

/// Attribute text of all elements, each `use` counted with what it shows, bytes. Two bytes are a path segment at
/// most, a segment some tens of bytes in memory.
const MAX_EXPANDED: u64 = 20 << 20;

/// Refuses entity declarations that could be a bomb: ones that name others, or that are long and often used.
/// What drawing programs write, short names of namespaces, passes.
pub(super) fn check_entities(text: &str) -> Result<(), FormatError> {
    let mut longest = 0;
    for declaration in text.split("<!ENTITY").skip(1) {
        let declaration = declaration.split('>').next().unwrap_or_default();
        if declaration.contains('&') || declaration.contains('%') {
            return Err(FormatError::Refused {
                what: "an entity that names another one",
                instead: "save the SVG without a DOCTYPE (\"plain SVG\")",
            });
        }
        longest = longest.max(declaration.len());
    }
    let uses = if longest == 0 { 0 } else { text.matches('&').count() };
    let most = usize::try_from(MAX_EXPANDED).unwrap_or(usize::MAX);
    match uses.saturating_mul(longest) > most {
        true => Err(FormatError::TooLarge { what: "SVG's entities", found: uses * longest, limit: most }),
        false => Ok(()),
    }
}

/// Refuses a tree that is too deep or, its `use` elements followed and its markers repeated, too large.
pub(super) fn check_tree(document: &Document) -> Result<(), FormatError> {
    let deepest = deepest(document);
    if deepest > MAX_DEPTH {
        return Err(FormatError::TooLarge { what: "SVG's nesting", found: deepest, limit: MAX_DEPTH });
    }
    check_style_sheets(document)?;
    let mut weights = Weights::of(document);
    let weight = weights.element(document.root_element(), 0).saturating_mul(weights.markers(document));
    match weight > MAX_EXPANDED {
        true => Err(FormatError::TooLarge {
            what: "SVG, its repetitions counted,",
            found: usize::try_from(weight).unwrap_or(usize::MAX),
            limit: usize::try_from(MAX_EXPANDED).unwrap_or(usize::MAX),
        }),
        false => Ok(()),
    }
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
    match refers && found > MAX_STYLED {
        true => Err(FormatError::TooLarge {
            what: "SVG's list of patterns, clips and masks for its style sheet",
            found,
            limit: MAX_STYLED,
        }),
        false => Ok(()),
    }
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
}

impl<'a> Weights<'a> {
    fn of(document: &'a Document<'a>) -> Self {
        let named = document.descendants().filter_map(|n| n.attribute("id").map(|id| (id, n)));
        Self { by_id: named.collect(), known: HashMap::new(), largest: swell::largest_size(document) }
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
