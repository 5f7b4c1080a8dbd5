//! `trace --film`: a moving picture of what was lit, and the one that the README shows.

use std::fs;

use crate::support::{folder, program, root};

/// The moving picture of a trace of that example.
fn film_of(name: &str, arguments: &[&str]) -> String {
    let dir = folder(name);
    let path = dir.join("film.svg");
    let output = program()
        .current_dir(root())
        .args(["trace", "--quiet", "--out"])
        .arg(dir.join("run"))
        .arg("--film")
        .arg(&path)
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    fs::read_to_string(path).unwrap()
}

#[test]
fn the_film_on_the_page_is_that_of_the_house() {
    let film = film_of("film", &["examples/house.png"]);
    let page = root().join("docs/house.svg");
    if std::env::var_os("RENEW_DOCS").is_some() {
        fs::write(&page, &film).unwrap();
    }
    assert_eq!(fs::read_to_string(page).unwrap(), film, "RENEW_DOCS=1 draws it anew");
    assert!(film.len() < 120_000, "{} bytes", film.len());
}

#[test]
fn a_film_shows_each_stroke_in_its_time_and_nothing_of_a_dry_run() {
    let film = film_of("film-star", &["examples/star.png"]);
    let animations: Vec<&str> = film.split("<animate ").skip(1).collect();
    assert!(animations.len() > 5);
    for animation in animations {
        let list = |name: &str| -> Vec<&str> {
            animation
                .split(&format!("{name}=\""))
                .nth(1)
                .unwrap()
                .split('"')
                .next()
                .unwrap()
                .split(';')
                .collect()
        };
        let (times, values) = (list("keyTimes"), list("values"));
        assert_eq!(times.len(), values.len(), "{animation}");
        let times: Vec<f64> = times.iter().map(|time| time.parse().unwrap()).collect();
        assert!(times[0] == 0.0 && times.is_sorted() && *times.last().unwrap() <= 1.0, "{animation}");
        // what is not discrete ends at the end, or no browser plays it
        assert!(animation.contains("discrete") || times.last() == Some(&1.0), "{animation}");
    }
    let dark = film_of("film-dark", &["examples/star.png", "--dry-run"]);
    assert!(!dark.contains("stroke-dasharray"), "light where none was");
}

#[test]
fn what_is_no_name_of_a_film_is_told_before_anything_is_drawn() {
    let output = program().args(["trace", "examples/star.png", "--film", "house.mp4"]).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && told.contains("does not end in .svg"), "{told}");
}
