//! The tags of an SVG, counted in one pass over its text, before anything is made of them.
//!
//! Whoever builds the tree compares each attribute of a tag with all others, each namespace with all that are in scope,
//! and each rule of a style sheet with each element: a few kilobytes are minutes. Nothing here says what is well formed;
//! text that is not is counted somehow and left to the parser, which refuses it.

use crate::svg::style::Style;

/// What a text has of all that costs more than its length.
#[derive(Default)]
pub(super) struct Tags<'a> {
    /// Elements.
    pub(super) elements: usize,
    /// Elements within each other at most.
    pub(super) depth: usize,
    /// Attributes of the tag that has most, namespaces among them.
    pub(super) attributes: usize,
    /// Namespaces that are in scope at once at most.
    pub(super) in_scope: usize,
    /// Comparisons that the scopes of namespaces take: the square of those in scope, for each tag that declares any.
    pub(super) scoping: u64,
    /// What looking at all elements costs, by which a rule of a style sheet is weighed.
    pub(super) looks: u64,
    /// The style sheets' text.
    pub(super) style: Style<'a>,
    /// Of each element that is open: namespaces in scope before it, and whether it is a style sheet.
    open: Vec<(usize, bool)>,
    now_in_scope: usize,
}

/// So many bytes of attributes cost a rule's look at an element as much as the look itself.
const BYTES_OF_LOOK: u64 = 256;

impl<'a> Tags<'a> {
    /// Of a whole document, or of what an entity stands for.
    pub(super) fn of(text: &'a str) -> Self {
        let mut tags = Self::default();
        let mut rest = text;
        while let Some(at) = rest.find('<') {
            tags.characters(&rest[..at]);
            rest = tags.markup(&rest[at..]);
        }
        tags
    }

    /// Text between tags.
    fn characters(&mut self, text: &'a str) {
        if self.open.last().is_some_and(|&(_, is_style)| is_style) {
            self.style.add(text);
        }
    }

    /// Takes one piece of markup off the text that begins with it.
    fn markup(&mut self, text: &'a str) -> &'a str {
        if let Some(comment) = text.strip_prefix("<!--") {
            after(comment, "-->")
        } else if let Some(characters) = text.strip_prefix("<![CDATA[") {
            let end = characters.find("]]>").unwrap_or(characters.len());
            self.characters(&characters[..end]);
            after(characters, "]]>")
        } else if text.starts_with("<?") {
            after(text, "?>")
        } else if text.starts_with("<!") {
            &text[end_of_declaration(text)..]
        } else if text.starts_with("</") {
            if let Some((before, _)) = self.open.pop() {
                self.now_in_scope = before;
            }
            after(text, ">")
        } else {
            let end = end_of_tag(text);
            self.tag(&text[1..end]);
            text[end..].strip_prefix('>').unwrap_or_default()
        }
    }

    /// What stands between a tag's brackets.
    fn tag(&mut self, tag: &'a str) {
        let name_end = tag.find(|c: char| c.is_ascii_whitespace() || c == '/').unwrap_or(tag.len());
        let (name, attributes) = tag.split_at(name_end);
        let before = self.now_in_scope;
        let (count, declared) = attributes_of(attributes);
        self.elements += 1;
        self.attributes = self.attributes.max(count);
        self.looks += 1 + tag.len() as u64 / BYTES_OF_LOOK;
        self.now_in_scope += declared;
        self.in_scope = self.in_scope.max(self.now_in_scope);
        if declared > 0 {
            let scope = self.now_in_scope as u64;
            self.scoping = self.scoping.saturating_add(scope.saturating_mul(scope));
        }
        self.depth = self.depth.max(self.open.len() + 1);
        if tag.ends_with('/') {
            self.now_in_scope = before;
        } else {
            let local = name.rsplit(':').next().unwrap_or_default();
            self.open.push((before, local == "style"));
        }
    }
}

fn after<'a>(text: &'a str, what: &str) -> &'a str {
    text.find(what).map_or("", |at| &text[at + what.len()..])
}

/// How many attributes stand in a tag, and how many of them are namespaces.
fn attributes_of(text: &str) -> (usize, usize) {
    let (mut count, mut declared) = (0, 0);
    let mut rest = text;
    while let Some((name, behind)) = rest.split_once('=') {
        count += 1;
        declared += usize::from(name.trim_start().starts_with("xmlns"));
        let value = behind.trim_start();
        rest = match value.chars().next() {
            Some(quote @ ('"' | '\'')) => value[1..].split_once(quote).map_or("", |(_, rest)| rest),
            _ => value,
        };
    }
    (count, declared)
}

/// Where the `>` of a tag stands that is in no quotes; the end of the text where there is none.
fn end_of_tag(text: &str) -> usize {
    let mut quote = None;
    for (at, byte) in text.bytes().enumerate() {
        match (quote, byte) {
            (None, b'>') => return at,
            (None, b'"' | b'\'') => quote = Some(byte),
            (Some(open), _) if open == byte => quote = None,
            _ => {}
        }
    }
    text.len()
}

/// Where a declaration such as `<!DOCTYPE … […]>` has ended.
fn end_of_declaration(text: &str) -> usize {
    let (mut depth, mut at) = (0_usize, 0);
    while at < text.len() {
        let rest = &text[at..];
        let first = rest.as_bytes()[0];
        at += match first {
            _ if rest.starts_with("<!--") => rest.find("-->").map_or(rest.len(), |end| end + 3),
            _ if rest.starts_with("<?") => rest.find("?>").map_or(rest.len(), |end| end + 2),
            b'"' | b'\'' => rest[1..].find(char::from(first)).map_or(rest.len(), |end| end + 2),
            _ => rest.chars().next().map_or(1, char::len_utf8),
        };
        match first {
            b'<' if !rest.starts_with("<!--") && !rest.starts_with("<?") => depth += 1,
            b'>' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            break;
        }
    }
    at
}
