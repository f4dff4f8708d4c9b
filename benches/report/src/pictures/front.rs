//! The picture at the top of the project's front page: one scene by the textbook, and by ours.

use figures::camera::Size;
use figures::render::Renderer;
use figures::scene_file;

use super::pixels::{Samples8, as_png, paint, samples};
use super::textbook::Painter;
use super::{HARD, batch};

const SIZE: Size = Size { width: 480, height: 360, samples: 1 };
/// Columns of white between the two.
const GAP: u32 = 12;

/// The far sphere, by the textbook in doubles on the left and by ours on the right, as the bytes of a PNG file.
pub(crate) fn front() -> Vec<u8> {
    let (name, text, _) = HARD[0];
    let scene = || scene_file::embedded(text, name).expect("scenes that are part of the program are valid");
    let drawn = scene();
    let view = drawn.view(SIZE).expect("the scene has a camera that sees it");
    let textbook = Painter::<f64>::new(&drawn);
    let left = paint(&view, |ray| samples(textbook.color(ray)));
    let right = batch(&Renderer::new(scene()), &view);
    let row = 3 * SIZE.width as usize;
    let rows = left.chunks_exact(row).zip(right.chunks_exact(row));
    let both: Samples8 = rows.flat_map(|(left, right)| [left, &[255; 3 * GAP as usize], right].concat()).collect();
    as_png(both, Size { width: 2 * SIZE.width + GAP, ..SIZE })
}

#[cfg(test)]
mod tests {
    use rt_io::{Limits, decode_image};

    use super::*;

    #[test]
    fn the_front_page_shows_what_is_drawn() {
        let stored = include_bytes!("../../../../docs/front.png");
        let pixels = |bytes: &[u8]| decode_image(bytes, &Limits::default()).unwrap().pixmap;
        assert!(pixels(stored) == pixels(&front()), "docs/front.png is another picture: report --front docs/front.png");
    }
}
