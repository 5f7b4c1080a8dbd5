use super::html::{escaped, number};
use crate::events::events;
use crate::finished::Finished;
use crate::origin::{badge, words};
use crate::summary::Summary;
use tracelight_rig::Phase;
use tracelight_vision::Quality;

const METRES_PER_INCH: f64 = 0.0254;

/// The figures that matter most, large.
pub(super) fn tiles(job: &Finished<'_>, figures: &Summary) -> String {
    let t = &figures.tracking;
    let at_speed = t.at_speed_share * 100.0;
    let by = words(job.origin.light_from).by;
    let tiles = [
        (number(t.rms_mm, 4), "mm", format!("tracking error, rms{by}")),
        (number(t.max_mm, 4), "mm", format!("largest error while lit{by}")),
        (number(t.overshoot_percent, 3), "%", format!("overshoot past ends and corners{by}")),
        (at_rest(t.final_error_mm), "mm", format!("error at rest{by}")),
        (number(t.lit_speed_m_s, 4), "m/s", "speed of the lit spot".to_owned()),
        (number(at_speed, 3), "%", "of the lit time within 2 % of the set speed".to_owned()),
        (number(figures.run.duration_s, 3), "s", "for the whole job".to_owned()),
        (number(torque_peak(job) * 100.0, 3), "%", "of the torque used at most".to_owned()),
    ];
    let tile = |(value, unit, what): (String, &str, String)| {
        format!(r#"<li><strong>{value}<small> {unit}</small></strong><span>{what}</span></li>"#)
    };
    tiles.into_iter().map(tile).collect()
}

/// A run that ended before its drawing did has no error at rest.
fn at_rest(final_error_mm: Option<f64>) -> String {
    final_error_mm.map_or_else(|| "–".to_owned(), |mm| number(mm, 4))
}

fn torque_peak(job: &Finished<'_>) -> f64 {
    job.plan.torque_peak_fraction()
}

/// One line below the title: size, place, speed.
pub(super) fn subtitle(job: &Finished<'_>) -> String {
    let target = &job.target;
    let inches = |m: f64| number(m / METRES_PER_INCH, 3);
    format!(
        "{} × {} mm ({} × {} in) at {} m, {} m/s",
        number(target.width_m * 1e3, 3),
        number(target.height_m * 1e3, 3),
        inches(target.width_m),
        inches(target.height_m),
        number(target.distance_m, 4),
        number(job.set_speed_m_s, 4)
    )
}

/// Every figure of the summary, grouped.
pub(super) fn figures(job: &Finished<'_>, f: &Summary) -> String {
    let share = |x: f64| number(x * 100.0, 3);
    let (lost, words) = (f.run.lost_counts, words(job.origin.light_from));
    let groups = [
        ("Picture and target".to_owned(), picture_rows(job, f)),
        ("Quality of the picture".to_owned(), job.quality.map(quality_rows).unwrap_or_default()),
        (
            "Plan".to_owned(),
            vec![
                row("duration", number(f.plan.duration_s, 4), "s"),
                row("lit", number(f.plan.lit_s, 4), "s"),
                row("set speed", number(f.plan.set_speed_m_s, 4), "m/s"),
                row("mean planned speed while lit", number(f.plan.speed_m_s, 4), "m/s"),
                row("highest torque, share of the limit", share(f.plan.torque_peak_fraction), "%"),
            ],
        ),
        (
            format!("Tracking{}", words.by),
            vec![
                row("spot to plan, rms", number(f.tracking.rms_mm, 4), "mm"),
                row("spot to plan, largest", number(f.tracking.max_mm, 4), "mm"),
                row("spot to stroke, rms", number(f.tracking.off_stroke_rms_mm, 4), "mm"),
                row("spot to stroke, largest", number(f.tracking.off_stroke_max_mm, 4), "mm"),
                row("overshoot", number(f.tracking.overshoot_percent, 4), "%"),
                row("final error", at_rest(f.tracking.final_error_mm), "mm"),
                row("speed of the lit spot", number(f.tracking.lit_speed_m_s, 4), "m/s"),
                row("lit time at the set speed ± 2 %", share(f.tracking.at_speed_share), "%"),
                row(words.lit, number(f.laser.lit_s, 4), "s"),
                row("lost counts put back, pan, tilt", format!("{}, {}", lost.pan, lost.tilt), ""),
            ],
        ),
        (
            "Time to make".to_owned(),
            vec![
                row("picture to strokes", number(f.timing_ms.vision, 3), "ms"),
                row("strokes to plan", number(f.timing_ms.plan, 3), "ms"),
                row("run", number(f.timing_ms.run, 3), "ms"),
            ],
        ),
    ];
    let filled = groups.into_iter().filter(|(_, rows)| !rows.is_empty());
    filled.map(|(title, rows)| group(&title, &rows.concat())).collect()
}

fn picture_rows(job: &Finished<'_>, f: &Summary) -> Vec<String> {
    let size = job.picture.map(|p| format!("{} × {}", p.raster.width(), p.raster.height()));
    let inches = |m: f64| format!("{} mm, {} in", number(m * 1e3, 4), number(m / METRES_PER_INCH, 4));
    let mut rows = vec![row("file", escaped(job.picture_path), "")];
    rows.extend(size.map(|size| row("size of the picture", size, "px")));
    rows.extend([
        row("width on the target", inches(f.target.width_m), ""),
        row("height on the target", inches(f.target.height_m), ""),
        row("where the head stands", escaped(&f.head.words()), ""),
        row("strokes", f.strokes.count.to_string(), ""),
        row("length of the strokes", number(f.strokes.length_m, 4), "m"),
        row("travel between them", number(f.strokes.travel_m, 4), "m"),
    ]);
    rows
}

fn quality_rows(q: &Quality) -> Vec<String> {
    let known = |value: Option<f64>| value.map_or_else(|| "not known".to_owned(), |v| number(v, 3));
    let unit = |value: Option<f64>| if value.is_some() { "px" } else { "" };
    vec![
        row("verdict", escaped(&q.words()), ""),
        row("contrast of the ink", number(q.contrast_percent, 3), "%"),
        row("contrast over the paper's noise", number(q.contrast_to_noise, 3), ""),
        row("noise", number(q.noise_levels, 3), "levels of 255"),
        row("darkest paper over brightest", number(q.light_evenness, 3), ""),
        row("ink's share of the picture", number(q.ink_percent, 3), "%"),
        row("width of the edges", known(q.edge_px), unit(q.edge_px)),
        row("burnt or black spots", number(q.clipped_percent, 3), "%"),
        row("width of the pen", known(q.pen_px), unit(q.pen_px)),
        row("broad ink whose edges fade", known(q.tone_percent), q.tone_percent.map_or("", |_| "%")),
    ]
}

/// What was asked for.
pub(super) fn settings(job: &Finished<'_>) -> String {
    let rows: String = job.settings.iter().map(|s| row(&escaped(&s.name), escaped(&s.value), "")).collect();
    let named = job.settings.iter().any(|s| s.name == "seed");
    let seed = if named { String::new() } else { row("seed", job.seed.to_string(), "") };
    group("Settings", &(rows + &seed))
}

/// A row of a table; name and value are HTML already.
fn row(name: &str, value: String, unit: &str) -> String {
    let gap = if unit.is_empty() { "" } else { "\u{202f}" };
    format!(r#"<tr><th scope="row">{name}</th><td>{value}{gap}{unit}</td></tr>"#)
}

fn group(title: &str, rows: &str) -> String {
    format!("<table><caption>{title}</caption><tbody>{rows}</tbody></table>")
}

/// Whether the job ended well: a class for the badge and its words.
pub(super) fn verdict(job: &Finished<'_>) -> (&'static str, String) {
    let events = events(job.run);
    if let Some(stop) = events.iter().find(|e| e.stops) {
        return ("bad", format!("stopped: {}", stop.code));
    }
    let Some(last) = job.run.ticks.last() else { return ("fair", "not run".to_owned()) };
    if last.telemetry.phase != Phase::Done {
        return ("bad", format!("not finished, darkened {} times", events.len()));
    }
    if job.dry_run {
        return ("fair", "dry run: dark on purpose".to_owned());
    }
    match events.len() {
        0 => ("good", "finished without a fault".to_owned()),
        1 => ("fair", "finished, darkened once".to_owned()),
        n => ("fair", format!("finished, darkened {n} times")),
    }
}

/// What says where the figures of the page come from.
pub(super) fn origin(job: &Finished<'_>) -> String {
    let (word, meaning) = badge(job.origin);
    format!(r#"<span class="badge fair" title="{meaning}">{word}</span>"#)
}

/// Faults, darkenings and remarks in words.
pub(super) fn happenings(job: &Finished<'_>) -> String {
    const MOST: usize = 100;
    let events = events(job.run);
    let event = |e: &crate::events::Event| {
        let class = if e.stops { "bad" } else { "fair" };
        let lasted = number(e.lasted_s * 1e3, 3);
        format!(
            r#"<li class="{class}"><b>{}</b> at {:.3} s for {lasted} ms. {}</li>"#,
            escaped(e.code),
            e.t_s,
            escaped(&e.told())
        )
    };
    let mut items: String = events.iter().take(MOST).map(event).collect();
    if events.len() > MOST {
        items += &format!("<li>and {} more</li>", events.len() - MOST);
    }
    items.extend(job.notes.iter().map(|note| format!("<li>{}</li>", escaped(note))));
    if items.is_empty() {
        items.push_str("<li class=\"good\">No fault, no darkening, no warning.</li>");
    }
    format!(r#"<ul class="happenings">{items}</ul>"#)
}
