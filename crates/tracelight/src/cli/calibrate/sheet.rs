use clap::{Args, ValueEnum};
use serde_json::json;
use tracelight_aim::Board;
use tracelight_eye::board::{BAR_M, page_pdf, page_svg};
use tracelight_files as files;
use tracelight_pipeline::Paper;
use tracelight_task::Failure;

use crate::cli::answer::{Answer, Voice};

/// Print pages of markers, to be put on the wall where a camera sees them
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight calibrate sheet -o pages.pdf --paper a4 --pages 4\n\n\
                  Print at 100 % (no \"fit to page\"), measure the bar at the foot of a page, and stick the pages flat on the wall, near the corners \
                  of where you will draw, turned as you like. Then take a picture: `tracelight calibrate markers`. Each page has markers of its own, of \
                  the AprilTag family 36h11: print no page twice.")]
pub(super) struct SheetArgs {
    /// File to write: .pdf, or .svg for one page
    #[arg(short, long, value_name = "FILE")]
    output: String,
    /// Paper size
    #[arg(long, value_enum, default_value_t = PaperName::A4)]
    paper: PaperName,
    /// fine: 20 markers of 40 mm a page; coarse: 4 of 84 mm, for cameras of few pixels or far away
    #[arg(long, value_enum, default_value_t = BoardName::Fine)]
    board: BoardName,
    /// Number of pages [default: 4, or 1 as SVG]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=26))]
    pages: Option<u16>,
    /// Number of the first page
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=26))]
    first: u16,
    #[command(flatten)]
    pub(super) voice: Voice,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum PaperName {
    /// 210 × 297 mm
    A4,
    /// 8.5 × 11 in
    Letter,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum BoardName {
    /// 20 markers of 40 mm
    Fine,
    /// 4 markers of 84 mm
    Coarse,
}

pub(super) fn run(args: &SheetArgs) -> Result<Answer, Failure> {
    let board = match args.board {
        BoardName::Fine => Board::FINE,
        BoardName::Coarse => Board::COARSE,
    };
    let paper = match args.paper {
        PaperName::A4 => Paper::A4,
        PaperName::Letter => Paper::LETTER,
    };
    let extension =
        std::path::Path::new(&args.output).extension().and_then(|e| e.to_str()).unwrap_or_default();
    let is_svg = extension.eq_ignore_ascii_case("svg");
    if !is_svg && !extension.eq_ignore_ascii_case("pdf") {
        return Err(Failure::usage("usage", format!("{}: a page is written as .pdf or .svg", args.output)));
    }
    let left = (board.pages + 1).saturating_sub(args.first).max(1);
    let pages = args.pages.unwrap_or(if is_svg { 1 } else { left.min(4) });
    let last = args.first + pages - 1;
    if last > board.pages {
        let message = format!("page {last} does not exist: the board has pages 1 to {}", board.pages);
        return Err(Failure::usage("usage", message));
    }
    if is_svg && pages > 1 {
        let message = format!(
            "{}: an SVG holds one page, not {pages}; write a .pdf, or one page at a time (--first N)",
            args.output
        );
        return Err(Failure::usage("usage", message));
    }
    if is_svg {
        files::write(&args.output, page_svg(&board, args.first - 1, paper))?;
    } else {
        let numbers: Vec<u16> = (args.first - 1..last).collect();
        files::write(&args.output, page_pdf(&board, &numbers, paper))?;
    }
    let text = format!(
        "{}: {}, {} markers of {:.0} mm on each\nPrint at 100 % and measure the bar: {:.0} mm. Stick the pages flat on the wall.",
        args.output,
        if pages == 1 { format!("page {last}") } else { format!("pages {} to {last}", args.first) },
        board.tags(),
        1e3 * board.tag_m,
        1e3 * BAR_M
    );
    let object = json!({
        "file": args.output,
        "pages": (args.first..=last).collect::<Vec<_>>(),
        "markers_a_page": board.tags(),
        "marker_m": board.tag_m,
        "pitch_m": board.pitch_m,
        "bar_m": BAR_M,
        "first_id": board.id(args.first - 1, 0),
    });
    Ok(Answer::new(text, object.to_string()))
}
