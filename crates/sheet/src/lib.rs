//! The sheet of paper that was photographed or scanned, and how bright its paper is everywhere.
//!
//! [`Page`] tells what of a picture is looked at: its sheet by itself, if there is one, with paper in the place of what lies beside it and
//! over it. [`Paper`] is that paper's brightness, also under what is drawn, where light falls off and where shadows lie.
//! All is in the pixel frame: x right, y down, the first pixel's centre is (0.5, 0.5). Nothing here knows what is drawn on it.
//!
//! A sheet's border is a long step of brightness that is seen from one side only: a line comes back behind it, a table does
//! not. On the picture averaged down to some 180 rows, medians over five pixels take lines out (`steps`); what steps
//! are left are gathered into straight sides (`sides`), which may go on as a dark line where the sheet lies on another
//! one. Of these and the picture's own borders the quadrilateral (`quad`) with most of its sides seen is chosen (`choice`),
//! a shadow that falls across it with it (`shade`), if what is seen along it and beside it says that it is a sheet
//! (`evidence`), and moved on to the full picture's steps (`edge`). Where it runs out of the picture a narrow strip of
//! the table may be left along the border (`rim`). All beside it, with what reaches in from there (`over`), is given its
//! paper's brightness (`alone`).
//!
//! | module | what |
//! |---|---|
//! | `page`, `sheet` | what of a picture is looked at; where its sheet lies |
//! | `small`, `steps`, `sides`, `quad`, `shade` | a smaller picture, its steps of brightness, sides along them, four of them, a shadow across |
//! | `choice`, `evidence`, `found` | the likeliest quadrilateral; whether it is a sheet; what is known of it |
//! | `edge`, `rim`, `straight` | sides where the full picture has them; a strip along its border; the line that most places are on |
//! | `over`, `alone` | what reaches over a sheet; the sheet cut out |
//! | `light`, `shadow` | the paper's brightness everywhere; steps in it |
//! | `two_tones` | pictures that no camera made |

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

mod alone;
mod choice;
mod edge;
mod evidence;
mod found;
mod light;
mod over;
mod page;
mod quad;
mod rim;
mod shade;
mod shadow;
mod sheet;
mod sides;
mod small;
mod steps;
mod straight;
mod two_tones;

pub use alone::Beside;
pub use light::Paper;
pub use page::Page;
pub use sheet::Sheet;
pub use two_tones::TwoTones;
