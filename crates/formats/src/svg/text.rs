//! Text of an SVG: which font it is set in, and what is said of that.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex};

use tracelight_letters::{Kind, bundled, named};
use usvg::fontdb::{Database, ID, Source, Style};
use usvg::{FontFamily, FontResolver, FontStyle, Node, Tree};

use crate::FormatError;
use crate::lettering::kind;
use crate::options::{FontFinder, Letters, ReadOptions};

/// Fonts that outlines come from: the given ones, those that are found by their names, and DejaVu Sans for what these lack.
pub(super) struct Fonts {
    all: Arc<Database>,
    given: Vec<ID>,
    bundled: Option<ID>,
    finder: Option<FontFinder>,
    /// Families that were looked for, by the name in small letters, with what was found.
    found: Mutex<BTreeMap<String, Vec<ID>>>,
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
        let finder = options.finder.clone();
        let (found, replaced) = (Mutex::default(), Mutex::default());
        Ok(Self { all: Arc::new(all), given, bundled, finder, found, unused, replaced })
    }

    pub(super) fn database(&self) -> Arc<Database> {
        self.all.clone()
    }

    /// A font of the family that is asked for, of the nearest weight: of the given ones, else of those that can be found. Else the
    /// first given one; else DejaVu Sans.
    pub(super) fn resolver(&self) -> FontResolver<'_> {
        FontResolver {
            select_font: Box::new(|font, all| self.select(font, all)),
            select_fallback: FontResolver::default_fallback_selector(),
        }
    }

    fn select(&self, font: &usvg::Font, all: &mut Arc<Database>) -> Option<ID> {
        let by_name = |family: &FontFamily| {
            let FontFamily::Named(wanted) = family else { return None };
            let known = self.given.iter().chain(&self.bundled).filter(|id| has_name(all, **id, wanted));
            let known: Vec<ID> = known.copied().collect();
            let known = if known.is_empty() { self.find(wanted, all) } else { known };
            known.into_iter().min_by_key(|id| difference(all, *id, font))
        };
        let by_name = font.families().iter().find_map(by_name);
        let id = by_name.or_else(|| self.given.first().copied()).or(self.bundled)?;
        self.note(font, difference(all, id, font), by_name.is_some());
        Some(id)
    }

    /// The faces of a family that is neither given nor in the program, each family looked for once.
    fn find(&self, wanted: &str, all: &mut Arc<Database>) -> Vec<ID> {
        let (Some(finder), Ok(mut found)) = (&self.finder, self.found.lock()) else { return Vec::new() };
        let faces = found.entry(wanted.to_lowercase()).or_insert_with(|| {
            let sources = finder.find(wanted).into_iter().map(|font| Source::Binary(Arc::new(font.bytes)));
            let all = Arc::make_mut(all);
            let faces: Vec<ID> = sources.flat_map(|source| all.load_font_source(source)).collect();
            faces.into_iter().filter(|id| has_name(all, *id, wanted)).collect()
        });
        faces.clone()
    }

    fn note(&self, font: &usvg::Font, (slant_differs, weights): (bool, u16), has_family: bool) {
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
            let found = if self.finder.is_none() { ", --system-fonts in one of this computer" } else { "" };
            format!("text in {names}{more} is drawn in {by}; --font FILE draws it in another font{found}")
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

fn has_name(all: &Database, id: ID, wanted: &str) -> bool {
    let is_own = |(name, _): &(String, _)| name.eq_ignore_ascii_case(wanted);
    all.face(id).is_some_and(|face| face.families.iter().any(is_own))
}

/// How far a face is from what is asked for: slant, then weight.
fn difference(all: &Database, id: ID, font: &usvg::Font) -> (bool, u16) {
    all.face(id).map_or((true, u16::MAX), |face| {
        let is_slanted = face.style != Style::Normal;
        (is_slanted != (font.style() != FontStyle::Normal), face.weight.0.abs_diff(font.weight()))
    })
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
