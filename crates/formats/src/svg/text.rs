//! Text of an SVG: which font it is set in, and what is said of that.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};

use tracelight_letters::{Kind, bundled, named};
use usvg::fontdb::{Database, ID, Source, Style};
use usvg::{FontFamily, FontResolver, FontStyle, Node, Tree};

use crate::FormatError;
use crate::lettering::kind;
use crate::options::{Letters, ReadOptions};

/// Fonts that outlines come from: the given ones, and DejaVu Sans for what these lack.
pub(super) struct Fonts {
    all: Arc<Database>,
    given: Vec<ID>,
    bundled: Option<ID>,
    /// Given fonts without outlines, by name.
    unused: Vec<String>,
    /// What the drawing asks for and does not get.
    replaced: Mutex<BTreeSet<String>>,
}

impl Fonts {
    /// # Errors
    /// A font that is none.
    pub(super) fn of(options: &ReadOptions) -> Result<Self, FormatError> {
        let mut all = Database::new();
        let (mut given, mut unused) = (Vec::new(), Vec::new());
        if kind(options, Letters::Outline)? == Kind::Outline {
            for font in &options.fonts {
                let faces = all.load_font_source(Source::Binary(Arc::new(font.bytes.clone())));
                if faces.is_empty() {
                    unused.push(font.name.clone());
                }
                given.extend(faces);
            }
        }
        let dejavu = bundled("dejavu").unwrap_or_default();
        let bundled = all.load_font_source(Source::Binary(Arc::new(dejavu))).first().copied();
        Ok(Self { all: Arc::new(all), given, bundled, unused, replaced: Mutex::default() })
    }

    pub(super) fn database(&self) -> Arc<Database> {
        self.all.clone()
    }

    /// A font of the family that is asked for, of the nearest weight; else the first given one; else DejaVu Sans.
    pub(super) fn resolver(&self) -> FontResolver<'_> {
        FontResolver {
            select_font: Box::new(|font, _| self.select(font)),
            select_fallback: FontResolver::default_fallback_selector(),
        }
    }

    fn select(&self, font: &usvg::Font) -> Option<ID> {
        let has_name = |id: &ID, wanted: &str| {
            let face = self.all.face(*id);
            face.is_some_and(|face| face.families.iter().any(|(name, _)| name.eq_ignore_ascii_case(wanted)))
        };
        let by_name = |family: &FontFamily| {
            let FontFamily::Named(wanted) = family else { return None };
            let known = self.given.iter().chain(&self.bundled).filter(|id| has_name(id, wanted));
            known.copied().min_by_key(|id| self.difference(*id, font))
        };
        let by_name = font.families().iter().find_map(by_name);
        let id = by_name.or_else(|| self.given.first().copied()).or(self.bundled)?;
        self.note(font, id, by_name.is_some());
        Some(id)
    }

    /// How far a face is from what is asked for: slant, then weight.
    fn difference(&self, id: ID, font: &usvg::Font) -> (bool, u16) {
        self.all.face(id).map_or((true, u16::MAX), |face| {
            let is_slanted = face.style != Style::Normal;
            (is_slanted != (font.style() != FontStyle::Normal), face.weight.0.abs_diff(font.weight()))
        })
    }

    fn note(&self, font: &usvg::Font, id: ID, has_family: bool) {
        const WEIGHTS_APART: u16 = 150;
        let Ok(mut replaced) = self.replaced.lock() else { return };
        match font.families().first() {
            // what a text has that names none
            Some(FontFamily::Named(name)) if name == "sans-serif" => false,
            Some(FontFamily::Named(name)) if !has_family => replaced.insert(name.clone()),
            Some(FontFamily::Serif) if !has_family => replaced.insert("serif".to_owned()),
            Some(FontFamily::Monospace) if !has_family => replaced.insert("monospace".to_owned()),
            _ => false,
        };
        let (slant_differs, weights) = self.difference(id, font);
        if slant_differs && font.style() != FontStyle::Normal {
            replaced.insert("italic".to_owned());
        }
        if weights > WEIGHTS_APART && font.weight() > 400 {
            replaced.insert("bold".to_owned());
        }
    }

    /// Says which fonts were replaced by which, and which characters no font has.
    pub(super) fn remarks(&self, tree: &Tree) -> Vec<String> {
        const NAMED: usize = 6;
        let first = self.given.first().copied().or(self.bundled).and_then(|id| self.all.face(id));
        let by = first.and_then(|face| face.families.first()).map_or("another font", |(name, _)| name);
        let replaced = self.replaced.lock().map(|replaced| replaced.iter().cloned().collect::<Vec<_>>());
        let replaced = replaced.unwrap_or_default();
        let fonts = (!replaced.is_empty()).then(|| {
            let more = if replaced.len() > NAMED { ", …" } else { "" };
            let names = replaced.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
            format!("text in {names}{more} is drawn in {by}; --font FILE draws it in another font")
        });
        let (mut missing, mut has_text) = (BTreeSet::new(), false);
        each_text(tree, &mut |text| {
            has_text = true;
            let glyphs = text.layouted().iter().flat_map(|span| &span.positioned_glyphs);
            missing
                .extend(glyphs.filter(|glyph| glyph.id.0 == 0).filter_map(|glyph| glyph.text.chars().next()));
        });
        missing.retain(|c| !c.is_control());
        let missing = (!missing.is_empty()).then(|| {
            format!("drawn as empty boxes: {}, which no font here has; --font FILE adds one", named(&missing))
        });
        let unused = (has_text && !self.unused.is_empty()).then(|| {
            let names = self.unused.join(", ");
            format!("not used: {names}, as the outlines of an SVG's text come from .ttf and .otf; --letters line draws single lines")
        });
        fonts.into_iter().chain(missing).chain(unused).collect()
    }
}

/// Shows every text of a tree.
fn each_text(tree: &Tree, show: &mut dyn FnMut(&usvg::Text)) {
    let mut left: Vec<&Node> = tree.root().children().iter().collect();
    while let Some(node) = left.pop() {
        match node {
            Node::Group(group) => left.extend(group.children()),
            Node::Text(text) => show(text),
            _ => {}
        }
    }
}
