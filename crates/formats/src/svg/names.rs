//! Which layer and which element of the file things lie on. The resolved tree knows elements by their ids only: those that have
//! none, and layers that share one, are given ids of their own before it is made.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;

use tracelight_stroke::Entity;
use usvg::roxmltree::{Document, Node};

use crate::layers::Layers;

/// What strokes in a group lie on.
#[derive(Clone, Default)]
pub(super) struct Place {
    /// Name of the layer.
    pub(super) layer: Option<Arc<str>>,
    /// The clone (`use`) that they are drawn by; it is found where they are, they elsewhere.
    pub(super) clone: Option<Arc<Entity>>,
    /// The name is that of a drawing program's layer, which ordinary groups within do not change.
    is_program_layer: bool,
}

/// What an id stands for.
enum Named {
    Group(Place),
    Clone(Arc<Entity>),
    Shape(Arc<Entity>),
}

/// Groups and shapes by the ids that the resolved tree has.
pub(super) struct Names {
    by_id: HashMap<String, Named>,
}

/// Elements that draw something.
const SHAPES: [&str; 8] = ["path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "text"];

/// What ids begin with that are given here.
const GIVEN: &str = "tracelight-element-";

/// What is inserted into a text, or put in place of a part of it.
type Change = (Range<usize>, String);

impl Names {
    /// The names of a document, and its text with the ids that it lacks, if it lacks any.
    pub(super) fn of(text: &str, document: &Document) -> (Self, Option<String>) {
        // what an entity of the document type holds stands in one place and is drawn in many
        let is_plain = !text.contains("<!ENTITY");
        let (mut layers, mut lines) = (Layers::default(), Lines { text, at: 0, line: 1 });
        let (mut by_id, mut ids) = (HashMap::new(), HashSet::new());
        let mut changes = Vec::new();
        for (number, node) in document.descendants().filter(Node::is_element).enumerate() {
            let Some(kind) = kind(&node) else { continue };
            let own = node.attribute_node("id").filter(|id| !id.value().is_empty());
            // links may lead to other elements of one id: these keep it
            let is_shared = own.is_some_and(|id| !ids.insert(id.value()) && is_program_layer(&node));
            let id = match own {
                Some(id) if !is_shared => id.value().to_owned(),
                // a group without a name has no part in this
                None if kind == "g" && !is_program_layer(&node) => continue,
                _ if !is_plain => continue,
                own => {
                    let given = format!("{GIVEN}{number}");
                    changes.push(match own {
                        Some(id) => (id.range_value(), given.clone()),
                        None => {
                            let at = behind_name(text, node.range().start);
                            (at..at, format!(" id=\"{given}\""))
                        }
                    });
                    given
                }
            };
            let line = is_plain.then(|| lines.of(node.range().start)).flatten();
            let entity = || {
                let id = own.map(|id| id.value().into());
                Arc::new(Entity { kind: kind.into(), id, line, more: 0 })
            };
            // of two elements of one id the first one counts
            by_id.entry(id).or_insert_with(|| match kind {
                "g" => Named::Group(place_of(&node, &mut layers)),
                "use" => Named::Clone(entity()),
                _ => Named::Shape(entity()),
            });
        }
        (Self { by_id }, (!changes.is_empty()).then(|| changed(text, &changes)))
    }

    /// Where strokes in the group of this id lie, within a group that lies at `around`.
    pub(super) fn within(&self, around: &Place, id: &str) -> Place {
        match self.by_id.get(id) {
            // a clone lies where it was put, whatever its original lies on
            Some(Named::Clone(entity)) if around.clone.is_none() => {
                Place { clone: Some(entity.clone()), ..around.clone() }
            }
            Some(Named::Group(own))
                if around.clone.is_none() && (own.is_program_layer || !around.is_program_layer) =>
            {
                own.clone()
            }
            _ => around.clone(),
        }
    }

    /// The element of this id, if it is drawn by itself and not by a clone.
    pub(super) fn entity(&self, around: &Place, id: &str) -> Option<Arc<Entity>> {
        match (&around.clone, self.by_id.get(id)) {
            (Some(clone), _) => Some(clone.clone()),
            (None, Some(Named::Shape(entity))) => Some(entity.clone()),
            _ => None,
        }
    }
}

/// The kind of an element that has a part in this.
fn kind(node: &Node) -> Option<&'static str> {
    let name = node.tag_name().name();
    SHAPES.iter().chain(&["g", "use"]).find(|kind| **kind == name).copied()
}

/// Inkscape's attributes, whatever prefix stands for its namespace.
fn of_inkscape<'a>(group: &Node<'a, '_>, name: &str) -> Option<&'a str> {
    group.attributes().find(|a| a.name() == name).map(|a| a.value())
}

fn is_program_layer(group: &Node) -> bool {
    of_inkscape(group, "groupmode") == Some("layer")
}

fn place_of(group: &Node, layers: &mut Layers) -> Place {
    let is_program_layer = is_program_layer(group);
    let label = of_inkscape(group, "label").filter(|_| is_program_layer);
    let name = label.or_else(|| group.attribute("id")).map(|name| layers.named(name));
    Place { layer: name, clone: None, is_program_layer }
}

/// The place behind the name of a tag that begins at `start`.
fn behind_name(text: &str, start: usize) -> usize {
    let is_end = |c: char| c.is_whitespace() || matches!(c, '/' | '>');
    text[start..].find(is_end).map_or(text.len(), |length| start + length)
}

fn changed(text: &str, changes: &[Change]) -> String {
    let mut out = String::with_capacity(text.len() + changes.iter().map(|(_, new)| new.len()).sum::<usize>());
    let mut at = 0;
    for (range, new) in changes {
        out.push_str(&text[at..range.start]);
        out.push_str(new);
        at = range.end;
    }
    out.push_str(&text[at..]);
    out
}

/// Counts lines on the way through a text.
struct Lines<'a> {
    text: &'a str,
    at: usize,
    line: u32,
}

impl Lines<'_> {
    /// The line of a place that does not lie before the one asked for before.
    fn of(&mut self, at: usize) -> Option<u32> {
        let passed = self.text.as_bytes().get(self.at..at)?;
        self.line += passed.iter().filter(|&&byte| byte == b'\n').count() as u32;
        self.at = at;
        Some(self.line)
    }
}
