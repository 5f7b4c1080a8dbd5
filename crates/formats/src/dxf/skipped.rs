//! What is in a file and not drawn, counted by name, and what to do about it.

use std::collections::BTreeMap;

use crate::FormatError;

/// What is in a space or a block and not drawn.
#[derive(Default)]
pub(super) struct Skipped {
    kinds: BTreeMap<String, usize>,
    /// Entities on layers that are off or frozen, or invisible themselves.
    pub(super) hidden: usize,
    /// Entities of layouts.
    pub(super) in_paper_space: usize,
    /// Inserts of blocks that are in another file, or nowhere.
    pub(super) missing_blocks: usize,
    /// Dimensions and tables whose block, which is their picture, is empty.
    pub(super) empty_pictures: usize,
    /// Entities that are a point seen from above, such as upright lines.
    pub(super) without_length: usize,
    /// Lines drawn whole, as their dashes are too many.
    pub(super) too_fine: usize,
    /// Hatches whose pattern has too many lines.
    pub(super) too_dense: usize,
    /// Points on the layer Defpoints, which is never printed.
    pub(super) unprinted: usize,
}

/// Why entities of a kind are not drawn.
#[derive(Clone, Copy, PartialEq)]
enum Why {
    Text,
    Endless,
    Picture,
    Solid,
    Other,
}

impl Why {
    /// One of each way out.
    const ALL: [Self; 4] = [Self::Other, Self::Solid, Self::Endless, Self::Picture];

    fn of(kind: &str) -> Self {
        match kind {
            "ATTDEF" | "RTEXT" | "ARCALIGNEDTEXT" => Self::Text,
            "RAY" | "XLINE" => Self::Endless,
            "IMAGE" | "WIPEOUT" | "OLEFRAME" | "OLE2FRAME" | "PDFUNDERLAY" | "DWFUNDERLAY"
            | "DGNUNDERLAY" => Self::Picture,
            "3DSOLID" | "REGION" | "BODY" | "SURFACE" | "PLANESURFACE" | "EXTRUDEDSURFACE"
            | "REVOLVEDSURFACE" | "LOFTEDSURFACE" | "SWEPTSURFACE" | "NURBSURFACE" => Self::Solid,
            _ => Self::Other,
        }
    }

    const fn way_out(self) -> &'static str {
        match self {
            Self::Text | Self::Other => "; explode them into lines and arcs",
            Self::Solid => ", which are solids or surfaces; export their edges",
            Self::Endless => ", which have no end; draw them as lines",
            Self::Picture => ", which are pictures or cover others; they have no lines",
        }
    }
}

impl Skipped {
    /// Counts an entity of a kind that is not drawn.
    pub(super) fn count(&mut self, kind: &[u8]) {
        const MOST_KINDS: usize = 50; // more than there are: the rest is rubbish
        let name = String::from_utf8_lossy(&kind[..kind.len().min(24)]).replace(char::is_control, "?");
        let is_known = self.kinds.len() < MOST_KINDS || self.kinds.contains_key(&name);
        *self.kinds.entry(if is_known { name } else { "others".into() }).or_default() += 1;
    }

    /// Counts what a block does not draw, once for each time it is inserted.
    pub(super) fn add(&mut self, block: &Self) {
        for (kind, count) in &block.kinds {
            *self.kinds.entry(kind.clone()).or_default() += count;
        }
        self.hidden += block.hidden;
        self.without_length += block.without_length;
        self.too_dense += block.too_dense;
        self.unprinted += block.unprinted;
    }

    /// How many kinds there are: the work that [`add`](Self::add) is.
    pub(super) fn kinds(&self) -> usize {
        self.kinds.len()
    }

    /// Whether nothing at all was counted but what lies in layouts.
    pub(super) fn is_empty(&self) -> bool {
        let [blocks, pictures] = [self.missing_blocks, self.empty_pictures];
        let counts = [self.hidden, blocks, pictures, self.without_length, self.unprinted];
        self.kinds.is_empty() && counts.iter().all(|&n| n == 0)
    }

    /// One sentence for each reason.
    pub(super) fn remarks(&self) -> Vec<String> {
        let said = |n: usize, what: &str| (n > 0).then(|| format!("not drawn: {what} ({n} found)"));
        let whole = (self.too_fine > 0)
            .then(|| format!("drawn without gaps: lines of too many dashes ({} found)", self.too_fine));
        let rest = [
            said(self.hidden, "what is invisible, or on a layer that is off or frozen"),
            said(self.in_paper_space, "layouts (paper space); the model is"),
            said(self.missing_blocks, "blocks that the file does not hold; bind them to it"),
            said(self.empty_pictures, "dimensions and tables of which the file holds no lines; explode them"),
            said(self.without_length, "what has no length seen from above, such as upright lines"),
            said(self.unprinted, "points on the layer Defpoints, which is never printed"),
            said(self.too_dense, "patterns of hatches that have too many lines; their edges are"),
            whole,
        ];
        Why::ALL.iter().filter_map(|&why| self.named(why)).chain(rest.into_iter().flatten()).collect()
    }

    /// The kinds that have one way out, the most frequent first.
    fn named(&self, why: Why) -> Option<String> {
        let is_of = |kind: &str| Why::of(kind).way_out() == why.way_out();
        let mut kinds: Vec<_> = self.kinds.iter().filter(|(kind, _)| is_of(kind)).collect();
        kinds.sort_by_key(|(_, n)| std::cmp::Reverse(**n));
        let named: Vec<_> = kinds.iter().map(|(kind, n)| format!("{n} {kind}")).collect();
        (!named.is_empty()).then(|| format!("not drawn: {}{}", named.join(", "), why.way_out()))
    }

    /// Why there is nothing to draw, by what the model holds.
    pub(super) fn nothing(&self) -> FormatError {
        let hint = self.hint();
        let named = self.kinds.iter().map(|(kind, n)| format!("{n} {kind}"));
        match named.reduce(|all, one| format!("{all}, {one}")) {
            Some(found) => FormatError::Undrawn { hint, found },
            None => FormatError::Nothing { hint },
        }
    }

    fn hint(&self) -> &'static str {
        let has = |why: Why| self.kinds.keys().any(|kind| Why::of(kind) == why);
        let entities: usize = self.kinds.values().sum();
        if self.hidden > 0 && self.hidden >= entities {
            "all layers of the DXF that hold something are off or frozen: turn them on"
        } else if has(Why::Text) {
            "the DXF holds text, not lines: explode the text into polylines"
        } else if has(Why::Solid) {
            "the DXF holds solids or surfaces, not lines: export their edges"
        } else if has(Why::Endless) {
            "the DXF holds only lines without an end (RAY, XLINE): draw them as lines"
        } else if has(Why::Picture) {
            "the DXF holds pictures, not lines: trace their own files"
        } else if has(Why::Other) {
            "the DXF holds only entities that are not drawn here: explode them into lines and arcs"
        } else if self.missing_blocks > 0 {
            "the DXF refers to blocks that it does not hold: bind them to it"
        } else if self.without_length > 0 {
            "what the DXF holds has no length seen from above"
        } else {
            "the DXF has no line, arc, polyline, ellipse or spline in its model, and none in a layout"
        }
    }
}
