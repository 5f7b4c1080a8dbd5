//! The pictures of `examples/` are what their generator draws, byte for byte.

use std::path::Path;

use crate::draw_examples;

#[test]
fn the_example_pictures_are_drawn_again_byte_for_byte() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let files = draw_examples::files().unwrap();
    assert_eq!(files.len(), 16, "eight pictures, each with its truth");
    for (name, bytes) in files {
        let same = std::fs::read(folder.join(&name)).is_ok_and(|there| there == bytes);
        assert!(
            same,
            "examples/{name} differs: cargo run --release -p tracelight-vision --example draw_examples -- examples"
        );
    }
}
