use std::collections::HashSet;
use std::sync::Arc;

/// Names of layers, each kept once however many strokes lie on it.
#[derive(Default)]
pub(crate) struct Layers {
    known: HashSet<Arc<str>>,
}

impl Layers {
    pub(crate) fn named(&mut self, name: &str) -> Arc<str> {
        match self.known.get(name) {
            Some(known) => known.clone(),
            None => {
                let new: Arc<str> = name.into();
                self.known.insert(new.clone());
                new
            }
        }
    }
}
