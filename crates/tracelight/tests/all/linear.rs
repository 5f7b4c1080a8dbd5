//! Linear models from the command line, held against the 2006 report and other tools.

use serde_json::{Value, json};
use tracelight_experiment::plant_file::{PlantFile, read};
use tracelight_experiment::table::Log;
use tracelight_linear::Time;

use crate::support::{folder, lab, near, run};

/// To the last digit the report printed.
fn printed_as(value: &Value, digits: &[f64], places: &[i32]) {
    let numbers = value.as_array().unwrap();
    assert_eq!(numbers.len(), digits.len(), "{value}");
    for ((number, digit), place) in numbers.iter().zip(digits).zip(places) {
        near(number, *digit, 0.5 * 10_f64.powi(-place));
    }
}

#[test]
fn a_linear_head_is_the_reports_to_every_digit() {
    let whole = lab(&["linearize", "--keep-cancellations"]);
    printed_as(&whole["G11"]["num"], &[13.16, 1.754, 10.29], &[2, 3, 2]);
    printed_as(&whole["G11"]["den"], &[1.0, 0.2649, 0.7997, 0.1029, 0.0], &[9, 4, 4, 4, 9]);
    let own = lab(&["linearize"]);
    printed_as(&own["G22"]["num"], &[13.33], &[2]);
    printed_as(&own["G22"]["den"], &[1.0, 0.1333, 0.7822], &[9, 4, 4]);
    printed_as(&own["G11"]["den"], &[1.0, 0.1316, 0.0], &[9, 4, 9]);
    // tilt's friction is the mean of both directions, nearly all inertia the motors' own
    let rig = lab(&["linearize", "--rig", "report", "--at", "0deg,0deg"]);
    near(&rig["A"][3][3], -0.0018 / 0.0750286, 1e-6);
    near(&rig["holding_nm"][1], -0.149_679, 1e-5);
}

#[test]
fn a_linear_head_is_written_and_read_back_to_the_bit() {
    let folder = folder("linearize_out");
    let whole = lab(&["linearize", "--at", "10deg,20deg"]);
    for name in ["head.toml", "head.json", "head.csv", "head.mat"] {
        let path = folder.join(name).display().to_string();
        assert_eq!(lab(&["linearize", "--at", "10deg,20deg", "-o", &path]), whole);
        let file = Log { name: name.into(), bytes: std::fs::read(&path).unwrap() };
        let PlantFile::StateSpace(system) = read(&file, None).unwrap().system else { panic!("{name}") };
        for (matrix, of) in [(system.a(), "A"), (system.b(), "B"), (system.c(), "C"), (system.d(), "D")] {
            for i in 0..matrix.nrows() {
                let row: Vec<f64> = matrix.row(i).iter().copied().collect();
                assert_eq!(json!(row), whole[of][i], "{name}: row {i} of {of}");
            }
        }
    }
    for arguments in
        [&["linearize"][..], &["bode", "G11"], &["pzmap", "G11", "--sample", "10ms", "--method", "foh"]]
    {
        let file = Log { name: "printed.json".into(), bytes: lab(arguments).to_string().into_bytes() };
        let printed = read(&file, None).unwrap().system;
        let sampled = matches!(&printed, PlantFile::Transfer(system) if system.time() == Time::Sampled(0.01));
        assert_eq!(sampled, arguments.contains(&"--sample"), "{arguments:?}: {printed:?}");
    }
}

#[test]
fn margins_of_the_reports_loops_are_those_of_other_tools() {
    let bode = lab(&["bode", "K11 G11", "K22 G22", "K11t G11", "K22t G22"]);
    for (system, degrees, rad_s, delay_s, modulus) in [
        (0, 29.0, 17.5, 28.8e-3, 0.50),
        (1, 29.2, 11.9, 43.0e-3, 0.50),
        (2, 64.5, 138.0, f64::NAN, f64::NAN),
        (3, 64.0, 114.0, f64::NAN, f64::NAN),
    ] {
        let margins = &bode["systems"][system]["margins"];
        near(&margins["phase"]["deg"], degrees, 0.05);
        near(&margins["phase"]["rad_s"], rad_s, 0.6);
        assert!(margins["gain"].is_null(), "{margins}");
        if delay_s.is_finite() {
            near(&margins["delay_s"], delay_s, 0.05e-3);
            near(&margins["modulus"]["distance"], modulus, 0.005);
        }
    }
    // at 1 kHz behind a hold there is a gain margin: 44 dB
    let sampled = lab(&["bode", "K11 G11", "--sample", "1ms"]);
    assert!(
        sampled["systems"][0]["margins"]["gain"]["db"].as_f64().is_some_and(|db| (40.0..60.0).contains(&db)),
        "{sampled}"
    );
    let closed = lab(&["pzmap", "K11 G11", "--closed"]);
    let slow = &closed["systems"][0]["poles"][0];
    near(&slow[0], -4.26, 0.005);
    near(&slow[1], 15.85, 0.005);
}

#[test]
fn linear_systems_are_plotted_and_tabled() {
    let dir = folder("lab-linear");
    let [svg, csv] = ["plot.svg", "table.csv"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    for (command, words, rows) in [
        ("bode", "amplification, dB", 1001),
        ("nyquist", "imaginary part", 1001),
        ("nichols", "closed loop", 1001),
        ("locus", "Root locus", 1002),
        ("pzmap", "crosses", 6),
    ] {
        for extra in [&[][..], &["--dark"], &["--sample", "2ms"]] {
            let arguments =
                [&[command, "(s+2)/(s (s+1)(s+9)^2)", "-o", &svg, "-o", &csv][..], extra].concat();
            assert!(lab(&arguments)["systems"][0]["poles"].is_array());
            let plot = std::fs::read_to_string(&svg).unwrap();
            assert!(plot.contains(words) && plot.trim_end().ends_with("</svg>"), "{arguments:?}");
            let table = std::fs::read_to_string(&csv).unwrap();
            assert!(
                table.lines().count() >= rows && !table.contains("NaN"),
                "{arguments:?}: {}",
                table.lines().count()
            );
        }
    }
    // nothing, a number, a loop whose highest powers cancel for one gain, poles on the edge
    for strange in
        ["0", "5", "s", "-s/(s+1)", "1/(s^2+1)^3", "(s+1)^40", "1/s^4 - 1/s^4", "1/(s+1e300)", "(1-s)/(1+s)"]
    {
        for command in ["bode", "nyquist", "nichols", "locus", "pzmap"] {
            let formula = format!("0+{strange}");
            assert!(
                lab(&[command, &formula, "-o", &svg, "-o", &csv, "--gain", "1"]
                    [..if command == "locus" { 8 } else { 6 }])["systems"]
                    .is_array()
            );
        }
    }
    let locus = lab(&["locus", "1/(s(s+1)(s+2))"]);
    near(&locus["systems"][0]["oscillating"][0]["gain"], 6.0, 1e-9);
    near(&locus["systems"][0]["breakaways"][0]["gain"], 0.3849, 1e-4);
}

#[test]
fn a_loop_at_the_edge_or_without_an_answer_is_said_to_be() {
    let bode = lab(&["bode", "1/(s(s+1))", "1/s^2", "(s+2)/(s+1)*(0-1)", "1/(s-2)^2"]);
    let said: Vec<&Value> =
        bode["systems"].as_array().unwrap().iter().map(|s| &s["closed_stability"]).collect();
    assert_eq!(said, [&json!("stable"), &json!("marginal"), &Value::Null, &json!("growing")]);
    let sampled = lab(&["bode", "K11*G11", "--sample", "1ms"]);
    let system = &sampled["systems"][0];
    assert_eq!((&system["stability"], &system["dc_gain"]), (&json!("marginal"), &Value::Null));
    assert_eq!(system["name"], "K11*G11, sampled every 1 ms by a hold");
    assert_eq!(system["closed_stability"], "stable");
    // what is 1 or real at every frequency has no margin, for another reason
    for (system, words) in [("(2-s)/(2+s)", "1 at every frequency"), ("3/(s^2+1)", "real at every frequency")]
    {
        let text = String::from_utf8(run(&["lab", "bode", system]).stdout).unwrap();
        assert!(text.contains(words), "{text}");
    }
}

#[test]
fn a_locus_ends_at_the_damping_that_is_asked_for() {
    let locus = lab(&["locus", "1/(s(s+1000))", "--damping", "0.7", "--points", "20"]);
    near(&locus["systems"][0]["gain"], 250_000.0 / 0.49, 1e-3);
    let many = run(&["lab", "locus", "1/(s+1)", "--damping", "0.7"]);
    assert!(String::from_utf8_lossy(&many.stderr).contains("every factor above 0"));
    // branches that come from infinity have their columns
    let dir = folder("locus-from-infinity");
    let csv = dir.join("locus.csv");
    lab(&["locus", "s^2/(s+1)", "-o", csv.to_str().unwrap()]);
    let text = std::fs::read_to_string(csv).unwrap();
    assert!(text.lines().all(|line| line.split(',').count() == 5), "{text}");
    let huge = run(&["lab", "locus", "1/(s+1)^60", "--points", "100000"]);
    assert!(String::from_utf8_lossy(&huge.stderr).contains("16666 is the most"));
}

/// A damping that no largest gain leaves is told, and the plot is made all the same.
#[test]
fn a_locus_without_the_damping_is_plotted_all_the_same() {
    let svg = folder("locus-without-damping").join("locus.svg");
    let out = run(&["lab", "locus", "1/(s-1)^2", "--damping", "0.5", "-o", svg.to_str().unwrap()]);
    let text = String::from_utf8(out.stdout).unwrap();
    assert!(out.status.success() && text.contains("no factor leaves"), "{text}");
    assert!(std::fs::read_to_string(svg).unwrap().contains("Root locus"));
}

/// What a plot proves is in it, in words that are read aloud too.
#[test]
fn plots_tell_what_matters() {
    let svg = folder("plots-that-tell").join("plot.svg");
    let plot = |arguments: &[&str]| {
        lab(&[arguments, &["-o", svg.to_str().unwrap()]].concat());
        std::fs::read_to_string(&svg).unwrap()
    };
    for (arguments, words) in [
        (&["nyquist", "3(s+6)^2/(s(s+1)^2)"][..], &["−4.5 at 3 rad/s", "½ turn clockwise", "near −1"][..]),
        (&["nyquist", "1/(s^4+s^3)"], &["ω = 0: 1½ turns clockwise"]),
        (&["nyquist", "1/s", "--reach", "5"], &["phase margin 90°"]),
        (&["bode", "G11"], &["phase margin 2.078° at 3.627 rad/s"]),
        (&["bode", "4/(s^2+0.5s)", "--closed"], &["resonance 12.11 dB", "bandwidth 3.073 rad/s"]),
        (&["nichols", "5/(s+1)^3"], &["gain margin 4.082 dB at 1.732 rad/s"]),
        (
            &["locus", "1/(s(s+1)(s+2)(s+10000))"],
            &["outside: pole −10000", "k = 3849", "k = 59982, 1.414 rad/s"],
        ),
        (&["response", "1/(s^2+0.4s+1)"], &["peak 1.527", "rise (10–90 %)", "settled (2 %)"]),
    ] {
        let drawn = plot(arguments);
        for word in words {
            // in the plot, and in its description
            assert!(
                drawn.matches(word).count() >= 2 || drawn.contains(&format!("{word})")),
                "{arguments:?}: {word}"
            );
        }
    }
}

/// A loop that is closed has no margins; where it has a bandwidth and a resonance they are told.
#[test]
fn a_closed_loop_has_a_bandwidth_and_a_resonance_but_no_margins() {
    let text = |arguments: &[&str]| {
        String::from_utf8(run(&[&["lab", "bode"][..], arguments].concat()).stdout).unwrap()
    };
    let closed = text(&["4/(s^2+0.5s)", "--closed"]);
    assert!(closed.contains("bandwidth") && closed.contains("resonance"), "{closed}");
    assert!(!closed.contains("margin") && !closed.contains("closed by negative feedback"), "{closed}");
    let json = lab(&["bode", "4/(s^2+0.5s)", "--closed"]);
    let system = &json["systems"][0];
    // 1 / (2 ζ √(1 − ζ²)) at ω √(1 − 2 ζ²), ζ = 1/8, ω = 2
    near(&system["resonance"]["factor"], 4.0 / (1.0_f64 - 1.0 / 64.0).sqrt(), 1e-9);
    near(&system["resonance"]["rad_s"], 2.0 * (1.0_f64 - 1.0 / 32.0).sqrt(), 1e-9);
    assert_eq!((&system["margins"], &system["closed_stability"]), (&Value::Null, &json!("stable")));
    let open = text(&["1/s"]);
    assert!(
        !open.contains("bandwidth") && !open.contains("resonance") && open.contains("phase margin"),
        "{open}"
    );
}

#[test]
fn a_bound_moves_the_other_if_that_is_not_typed() {
    let bode = lab(&["bode", "1/s", "--from", "100rad/s", "--points", "2"]);
    near(&bode["rad_s"][0], 100.0, 1e-9);
    near(&bode["rad_s"][1], 1e4, 1e-6);
    let sampled = lab(&["bode", "0.1/(z-0.9)", "--period", "1ms", "--from", "100rad/s", "--points", "2"]);
    near(&sampled["rad_s"][1], std::f64::consts::PI * 1e3, 1e-6);
    let refused = run(&["lab", "bode", "1/s", "--from", "100rad/s", "--to", "10rad/s"]);
    assert!(!refused.status.success());
}

#[test]
fn a_controller_is_designed_and_meets_its_wishes() {
    let margin = |design: &Value| design["margins"]["phase"].clone();
    let lead = lab(&[
        "design",
        "lead-lag",
        "G11",
        "--crossover",
        "60rad/s",
        "--phase-margin",
        "55deg",
        "--lag",
        "10",
    ]);
    near(&margin(&lead)["rad_s"], 60.0, 1e-9);
    near(&margin(&lead)["deg"], 55.0, 1e-9);
    let pid = lab(&["design", "pid", "G22", "--crossover", "40rad/s", "--modulus", "0.7"]);
    near(&margin(&pid)["deg"], 55.0, 1e-6);
    assert!(pid["margins"]["modulus"]["distance"].as_f64().unwrap() >= 0.7 - 1e-9, "{pid}");
    let placed = lab(&["design", "place", "G11", "--poles=-40+30j,-20", "--estimator", "-200,-210"]);
    let poles: Vec<f64> =
        placed["closed_poles"].as_array().unwrap().iter().map(|p| p[0].as_f64().unwrap()).collect();
    for (pole, wanted) in poles.iter().zip([-20.0, -40.0, -40.0, -200.0, -210.0]) {
        assert!((pole - wanted).abs() < 1e-4, "{poles:?}");
    }
    // an estimator nobody asked for is faster, in z as in s
    let own = lab(&["design", "place", "G11", "--sample", "1ms", "--poles", "0.95,0.96"]);
    assert_eq!((&own["closed_stable"], own["closed_poles"].as_array().unwrap().len()), (&json!(true), 4));
    let own = lab(&["design", "place", "G11", "--poles=-15,-40+30j"]);
    near(&own["closed_poles"][4][0], -160.0, 1e-3);
    // wished to grow, it does
    let grows = lab(&["design", "place", "G11", "--poles", "30,40"]);
    assert_eq!((&grows["closed_stability"], &grows["step"]), (&json!("growing"), &Value::Null));
    let sampled = lab(&["design", "lqg", "G11", "--sample", "1ms", "--integral", "1e-4"]);
    assert_eq!(sampled["closed_stable"], true);
    // the printed formula is the controller
    let text = lead["controller"]["text"].as_str().unwrap();
    let again = lab(&["bode", &format!("({text}) G11")]);
    near(&again["systems"][0]["margins"]["phase"]["deg"], 55.0, 0.1);
}

/// The head as it is beside the head linearized, in one table.
#[test]
fn a_designed_controller_drives_a_rig() {
    let dir = folder("design-trial");
    let (svg, csv) = (dir.join("loop.svg"), dir.join("loop.csv"));
    let wish =
        ["design", "lead-lag", "G11", "--crossover", "30rad/s", "--phase-margin", "60deg", "--try", "pan"];
    let design = lab(&[&wish[..], &["-o", svg.to_str().unwrap(), "-o", csv.to_str().unwrap()]].concat());
    let trial = &design["trial"];
    // sampled at 1 kHz it is the loop on paper
    let (paper, linear) = (&design["step"]["overshoot_percent"], &trial["linear"]["overshoot_percent"]);
    near(linear, paper.as_f64().unwrap(), 1.5);
    // friction takes of the overshoot, and leaves an error
    assert!(trial["overshoot_percent"].as_f64() < linear.as_f64(), "{trial}");
    assert!(trial["final_error_mm"].as_f64().unwrap() > 0.0 && design["closed_stable"] == true);
    let drawn = std::fs::read_to_string(svg).unwrap();
    assert!(drawn.contains("command, V") && drawn.contains("pan of rig report"), "{drawn}");
    assert_eq!(std::fs::read_to_string(csv).unwrap().lines().count(), 2002);
}

#[test]
fn what_cannot_be_designed_is_refused_in_a_sentence() {
    for (arguments, words) in [
        ("pid 1/s --modulus 0.95", "at most"),
        ("pid 1/(s(s+1))", "choose one"),
        ("pid 1/(10s+1)", "the missing wish is --crossover 0.3rad/s"),
        ("pid 1/s^2 --type pi", "try a PID"),
        ("pid 1/s^2 --type pd --crossover 2rad/s --overshoot 5", "without an integral"),
        ("lqr G11 --q 1", "1 numbers for 2 states"),
        ("lqr G11 --q z=1", "the states are y, dy"),
        ("lqr G11 --q 0,0", "give the first state a weight"),
        ("lead-lag 1/(s+1)^6 --crossover 10rad/s --phase-margin 60deg", "of phase are missing"),
        ("place G11 --poles=-1", "give as many"),
        ("place G11 --poles=-1,x", "is no pole"),
        ("place G11 --poles=-1,2e+3j", "is no pole"),
        ("lqg 1/s --noise 0", "noise's size"),
        ("lqg (s-1)/((s-1)(s+2))", "brings that system to rest"),
        ("lqg s", "more zeros than poles"),
        ("place 1/(s+1)^4 --poles=-3,-4,-5,-6,-7 --try pan", "does not fit"),
        ("lead-lag G11 --sample 1ms --crossover 10rad/s --phase-margin 60deg", "continuous time"),
        ("pid 1/(s+1)^60", "order 24"),
        ("place G11 --poles=-1e300,-1e300", "no pole"),
        ("lqg 5", "no states"),
        ("lqg 1/(s-1)^12", "digits"),
        ("place G11 --poles=-40+30j,-50+2j --estimator=-1,-2", "give as many"),
        ("pid G11 --crossover 10rad/s --to 3deg", "--try"),
    ] {
        let arguments: Vec<&str> = ["lab", "design"].into_iter().chain(arguments.split(' ')).collect();
        let output = run(&arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(matches!(output.status.code(), Some(1 | 2)), "{arguments:?}: {message}");
        assert!(message.contains(words), "{arguments:?}: {message}");
    }
}

/// The same plot as pixels, 144 to the inch, its words drawn whatever fonts there are.
#[test]
fn a_plot_is_written_as_pixels() {
    let dir = folder("plot-pixels");
    let (svg, png, dark) = (dir.join("b.svg"), dir.join("b.png"), dir.join("d.png"));
    lab(&["bode", "K11*G11", "K11t*G11", "-o", svg.to_str().unwrap(), "-o", png.to_str().unwrap()]);
    lab(&["bode", "K11*G11", "--dark", "-o", dark.to_str().unwrap()]);
    let drawn = std::fs::read_to_string(svg).unwrap();
    let length = |name: &str| {
        let at = drawn.find(&format!("{name}=\"")).unwrap() + name.len() + 2;
        drawn[at..].split('"').next().unwrap().parse::<u32>().unwrap()
    };
    let image = image::open(png).unwrap().to_luma8();
    assert_eq!(image.dimensions(), (length("width") * 3 / 2, length("height") * 3 / 2));
    let share = |image: &image::GrayImage, dark: bool| {
        // the title's row, left
        let inked = (0..400).flat_map(|x| (0..48).map(move |y| (x, y))).filter(|&(x, y)| {
            let grey = image.get_pixel(x, y)[0];
            if dark { grey > 128 } else { grey < 128 }
        });
        inked.count() as f64 / (400.0 * 48.0)
    };
    assert!((0.02..0.3).contains(&share(&image, false)), "{}", share(&image, false));
    let night = image::open(dark).unwrap().to_luma8();
    assert!((0.02..0.3).contains(&share(&night, true)), "{}", share(&night, true));
}

#[test]
fn systems_on_paper_answer_as_the_textbook_says() {
    let steps = lab(&["response", "K11 G11", "K11t G11", "--closed", "--duration", "1s"]);
    near(&steps["systems"][0]["overshoot_percent"], 49.4, 0.05);
    near(&steps["systems"][1]["overshoot_percent"], 12.6, 0.05);
    // 1 − e⁻ᵗ, its slope, its integral
    let one = |input: &str, points: &str| {
        let answer = lab(&["response", "1/(s+1)", "--input", input, "--duration", "3s", "--points", points]);
        answer["systems"][0]["values"].as_array().unwrap().last().unwrap().as_f64().unwrap()
    };
    let decayed = (-3.0_f64).exp();
    for (input, wanted) in [("step", 1.0 - decayed), ("impulse", decayed), ("ramp", 2.0 + decayed)] {
        assert!((one(input, "7") - wanted).abs() < 1e-12, "{input}");
    }
    let sampled =
        lab(&["response", "1/(z-0.5)", "--period", "0.1s", "--input", "impulse", "--duration", "0.5s"]);
    assert_eq!(sampled["systems"][0]["values"], json!([0.0, 1.0, 0.5, 0.25, 0.125, 0.0625]));
    let ramp = lab(&["response", "z/(z-1)", "--period", "0.1s", "--input", "ramp", "--duration", "0.25s"]);
    near(&ramp["systems"][0]["values"][2], 0.3, 1e-12);
    let dir = folder("responses");
    let (png, csv) = (dir.join("r.png"), dir.join("r.csv"));
    lab(&[
        "response",
        "1/(s+1)",
        "K11 G11",
        "--points",
        "50",
        "-o",
        png.to_str().unwrap(),
        "-o",
        csv.to_str().unwrap(),
    ]);
    assert!(image::open(png).unwrap().width() == 1230);
    let text = std::fs::read_to_string(csv).unwrap();
    assert!(text.starts_with("t_s_1,output_1,t_s_2,output_2\n") && text.lines().count() == 51, "{text}");
    for (arguments, words) in [
        (["s", "--input", "step"], "more zeros than poles"),
        (["1/(s+1)", "--duration", "0s"], "not above zero"),
        (["1/s", "--points", "1"], "from 2 to 100000"),
    ] {
        let refused = run(&[&["lab", "response"], &arguments[..]].concat());
        let message = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(!refused.status.success() && message.contains(words), "{message}");
    }
}

#[test]
fn frequencies_are_in_hertz_or_in_radians_a_second() {
    let [hertz, radians] = [["1Hz", "0.01kHz"], ["6.283185307179586rad/s", "62.83185307179586rad/s"]]
        .map(|[from, to]| lab(&["bode", "G11", "--from", from, "--to", to])["rad_s"].clone());
    near(&hertz[0], std::f64::consts::TAU, 1e-12);
    assert_eq!(hertz.as_array().unwrap().len(), radians.as_array().unwrap().len());
    let sampled = lab(&["pzmap", "1/(s+1)", "--sample", "10Hz"]);
    near(&sampled["systems"][0]["poles"][0][0], (-0.1_f64).exp(), 1e-12);
}

/// Large jumps keep the amplifier at its limit: back-calculation keeps the integral from winding up meanwhile.
#[test]
fn a_designed_pid_is_tried_with_anti_windup_and_without() {
    let design = lab(&["design", "pid", "G11", "--crossover", "40rad/s", "--try", "pan", "--to", "40deg"]);
    let trial = &design["trial"];
    let number = |value: &Value| value.as_f64().unwrap();
    let (kept, wound) =
        (number(&trial["overshoot_percent"]), number(&trial["without_anti_windup"]["overshoot_percent"]));
    assert!(kept < 40.0 && wound > 3.0 * kept, "{trial}");
    assert!((0.05..0.95).contains(&number(&trial["limited_share"])), "{trial}");
    near(&trial["tracking_s"], (number(&design["pid"]["kd"]) / number(&design["pid"]["ki"])).sqrt(), 1e-9);
    // the head linearized overshoots as the paper says, but for the ticks
    near(&trial["linear"]["overshoot_percent"], number(&design["step"]["overshoot_percent"]), 1.5);
    // and at its ticks it keeps nearly the margins
    near(&trial["sampled"]["phase_margin_deg"], 55.0, 1.5);
    let weighted = lab(&["design", "pid", "G11", "--crossover", "40rad/s", "--overshoot", "10"]);
    near(&weighted["pid"]["weighted_step"]["overshoot_percent"], 10.0, 1e-3);
    assert_eq!(weighted["pid"]["load"], design["pid"]["load"]);
    assert_eq!(weighted["step"], design["step"]);
}

#[test]
fn states_are_weighed_one_by_one_by_name_or_by_what_is_allowed() {
    let each = lab(&["design", "lqr", "G11", "--q", "1000,1"]);
    assert_eq!(each["gain"], lab(&["design", "lqr", "G11", "--q", "dy=1,y=1000"])["gain"]);
    assert!(each["margins"]["phase"]["deg"].as_f64().is_some_and(|deg| deg >= 60.0), "{each}");
    // b² k1² = b² q1/r: from Riccati's equation of a chain
    near(&each["gain"][0], 1000_f64.sqrt(), 1e-6);
    let most = ["design", "lqr", "G11", "--most", "y=0.02", "--most-input", "0.6", "--integral", "0.01"];
    let allowed = lab(&most);
    let reached = &allowed["allowed"]["reached"];
    assert!(reached[3].as_f64().unwrap() > 0.6, "{reached}");
    let r = allowed["allowed"]["nearest_r"].as_f64().unwrap().to_string();
    let nearest = lab(&["design", "lqr", "G11", "--q", "2500,0", "--r", &r, "--integral", "10000"]);
    // the first moment is its largest, where the input is the first gain times the deviation
    near(&nearest["gain"][0], 0.6 / 0.02, 1e-3);
    near(&nearest["step"]["final"], 1.0, 1e-6);
}
