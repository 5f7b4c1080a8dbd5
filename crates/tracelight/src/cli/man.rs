use std::path::PathBuf;

use clap::{Args, Command};
use clap_mangen::Man;
use serde_json::json;
use tracelight_files as files;
use tracelight_task::{Failure, counted};

use crate::cli::answer::{Answer, Voice};

/// Write manual pages for `man`, one per command
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight man -o ~/.local/share/man/man1")]
pub(crate) struct ManArgs {
    /// Folder for the pages, which is made if missing
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

/// A page's file name and what is in it.
type Page = (String, Vec<u8>);

pub(crate) fn run(args: &ManArgs, program: Command) -> Result<Answer, Failure> {
    let folder = args.out.display();
    let failed = |e: std::io::Error| {
        let message = format!("cannot write {folder}: {e}; choose another folder with --out");
        Failure::failed("cannot-write", message)
    };
    let mut program = program.disable_help_subcommand(true);
    program.build(); // names commands within commands
    let mut pages = Vec::new();
    add(&program, &mut pages).map_err(failed)?;
    std::fs::create_dir_all(&args.out).map_err(failed)?;
    for (name, page) in &pages {
        files::write(&args.out.join(name).display().to_string(), page)?;
    }
    let names: Vec<&str> = pages.iter().map(|(name, _)| name.as_str()).collect();
    let text = format!("{folder}: {}", counted(pages.len(), "page"));
    Ok(Answer::new(text, json!({ "path": args.out, "pages": names }).to_string()))
}

/// A command's page, and those of the commands below it.
fn add(command: &Command, pages: &mut Vec<Page>) -> std::io::Result<()> {
    let man = Man::new(command.clone());
    let mut page = Vec::new();
    man.render(&mut page)?;
    pages.push((man.get_filename(), page));
    command.get_subcommands().filter(|below| !below.is_hide_set()).try_for_each(|below| add(below, pages))
}
