//! Names of an SVG's groups, which the resolved tree knows by their ids only.

use std::collections::HashMap;
use std::sync::Arc;

use usvg::roxmltree::{Document, Node};

use crate::layers::Layers;

/// What strokes in a group lie on.
#[derive(Clone, Default)]
pub(super) struct Place {
    /// Name of the layer.
    pub(super) layer: Option<Arc<str>>,
    /// The name is that of a drawing program's layer, which ordinary groups within do not change.
    is_program_layer: bool,
}

/// A place for each group that has an id.
pub(super) struct Names {
    by_id: HashMap<String, Place>,
}

impl Names {
    pub(super) fn of(document: &Document) -> Self {
        let mut layers = Layers::default();
        let groups = document.descendants().filter(|n| n.tag_name().name() == "g");
        let named = groups.filter_map(|n| Some((n.attribute("id")?.to_owned(), place_of(&n, &mut layers))));
        Self { by_id: named.collect() }
    }

    /// Where strokes in the group of this id lie, within a group that lies at `around`.
    pub(super) fn within(&self, around: &Place, id: &str) -> Place {
        match self.by_id.get(id) {
            Some(own) if own.is_program_layer || !around.is_program_layer => own.clone(),
            _ => around.clone(),
        }
    }
}

fn place_of(group: &Node, layers: &mut Layers) -> Place {
    // Inkscape's attributes, whatever prefix stands for its namespace
    let own = |name: &str| group.attributes().find(|a| a.name() == name).map(|a| a.value());
    let is_program_layer = own("groupmode") == Some("layer");
    let label = own("label").filter(|_| is_program_layer);
    Place { layer: label.or(own("id")).map(|name| layers.named(name)), is_program_layer }
}
