//! Files as people have them, and as nobody should.

use tracelight_experiment::plant_file::{Plant, PlantFile, PlantFormat, read, write};
use tracelight_experiment::table::Log;
use tracelight_linear::{Complex, Matrix, StateSpace, Time, TransferFunction};
use tracelight_maths::{complex, log10, powi};

fn of(name: &str, bytes: &[u8], choice: Option<&str>) -> Result<Plant, String> {
    read(&Log { name: name.into(), bytes: bytes.to_vec() }, choice).map_err(|failure| {
        assert_eq!(failure.code, "system-file");
        failure.message
    })
}

fn text(name: &str, text: &str) -> Result<PlantFile, String> {
    of(name, text.as_bytes(), None).map(|plant| plant.system)
}

#[track_caller]
fn state_space(file: Result<PlantFile, String>) -> StateSpace {
    match file {
        Ok(PlantFile::StateSpace(system)) => system,
        other => panic!("no state space: {other:?}"),
    }
}

#[track_caller]
fn transfer(file: Result<PlantFile, String>) -> TransferFunction {
    match file {
        Ok(PlantFile::Transfer(system)) => system,
        other => panic!("no transfer function: {other:?}"),
    }
}

/// ẍ = u − 2 x − 3 ẋ, seen with a little of its rate.
fn motor(time: Time) -> StateSpace {
    let a = Matrix::from_row_slice(2, 2, &[0.0, 1.0, -2.0, -3.0000000000000004]);
    let b = Matrix::from_column_slice(2, 1, &[0.0, 1.0]);
    StateSpace::new(a, b, Matrix::from_row_slice(1, 2, &[1.0, 0.1]), Matrix::zeros(1, 1), time).unwrap()
}

#[test]
fn matrices_are_read_however_they_are_written() {
    let sampled = motor(Time::Sampled(0.01));
    for (name, file) in [
        (
            "p.toml",
            "A = [[0, 1], [-2, -3.0000000000000004]]\nB = [[0], [1]]\nC = [[1, 0.1]]\nD = [[0]]\nperiod_s = 0.01\n",
        ),
        (
            "p.toml",
            "[system]\na = [[0, 1], [-2, -3.0000000000000004]]\nb = [0, 1]\nc = [1, 0.1]\nd = 0\ndt = 1e-2\n",
        ),
        (
            "p.json",
            r#"{"A":[[0,1],[-2,-3.0000000000000004]],"B":[[0],[1]],"C":[[1,0.1]],"D":[[0]],"Ts":0.01,"note":"x"}"#,
        ),
        (
            "p.json",
            "{\"system\": {\"A\":[[0,1],[-2,-3.0000000000000004]],\"B\":[0,1],\"C\":[1,0.1],\"D\":0,\"dt\":0.01}}",
        ),
        ("p.csv", "A\n0,1\n-2,-3.0000000000000004\nB\n0\n1\nC\n1,0.1\nD\n0\nTs\n0.01\n"),
        ("p.csv", "A,,\n0,1,\n-2,-3.0000000000000004,\n,,\nB,,\n0,,\n1,,\nC,,\n1,0.1,\nD,,\n0,,\nTs,0.01,\n"),
        (
            "p.csv",
            "\u{feff}\"A\"\r\n0;1\r\n-2;-3,0000000000000004\r\nB\r\n0\r\n1\r\nC\r\n1;0,1\r\nD\r\n0\r\ndt;0,01\r\n",
        ),
        (
            "p.txt",
            "% A motor\nA =\n 0  1\n-2 -3.0000000000000004\n\nB =\n0\n1\nC =\n1 0.1\nD = 0\nTs = 0.01\n",
        ),
    ] {
        assert_eq!(state_space(text(name, file)), sampled, "{name}: {file}");
    }
}

#[test]
fn a_missing_period_is_continuous_time_and_names_are_kept() {
    for period in ["", "\"dt\": null, ", "\"dt\": 0, ", "\"dt\": \"None\", "] {
        let file = format!(
            "{{{period}\"A\":[[-1]],\"B\":[[1]],\"C\":[[1],[2]],\"D\":[[0],[0]],\"outputs\":[\"x\",\"y\"]}}"
        );
        let plant = of("p.json", file.as_bytes(), None).unwrap();
        assert_eq!(plant.outputs, ["x", "y"]);
        assert_eq!(state_space(Ok(plant.system)).time(), Time::Continuous);
    }
}

#[test]
fn transfer_functions_are_read_as_quotients_and_as_factors() {
    let truth = TransferFunction::parse("4 (s+3)/(s^2+2s+5)", Time::Continuous).unwrap();
    for (name, file) in [
        ("g.json", r#"{"num":[4,12],"den":[1,2,5]}"#),
        ("g.json", r#"{"num":[[8,24]],"den":[[2,4,10]],"zeros":[[-3,0]],"poles":[]}"#),
        ("g.json", r#"{"gain":4,"zeros":[-3],"poles":[[-1,2],[-1,-2]]}"#),
        ("g.json", r#"{"k":4,"z":[-3],"p":["-1+2j","(-1-2j)"]}"#),
        ("g.toml", "numerator = [4, 12]\ndenominator = [1, 2, 5]"),
        ("g.csv", "num,4,12\nden,1,2,5\n"),
    ] {
        let ours = transfer(text(name, file));
        let at = Complex::new(0.3, 1.0);
        assert!(complex::norm(ours.at(at) - truth.at(at)) < 1e-14, "{file}: {ours}");
    }
}

#[test]
fn what_is_written_is_read_back_to_the_bit() {
    let mut random = oorandom::Rand64::new(7);
    for (n, m, p) in [(2, 1, 1), (5, 3, 2), (1, 2, 4), (0, 1, 1), (0, 2, 3), (200, 32, 32)] {
        let mut matrix = |rows, columns| {
            Matrix::from_fn(rows, columns, |_, _| {
                (random.rand_float() - 0.5) * powi(10.0, random.rand_range(0..30) as i32 - 15)
            })
        };
        let (a, b, c, d) = (matrix(n, n), matrix(n, m), matrix(p, n), matrix(p, m));
        for time in [Time::Continuous, Time::Sampled(1.0 / 3.0)] {
            let system = StateSpace::new(a.clone(), b.clone(), c.clone(), d.clone(), time).unwrap();
            for (name, format) in [
                ("p.toml", PlantFormat::Toml),
                ("p.json", PlantFormat::Json),
                ("p.csv", PlantFormat::Csv),
                ("p.mat", PlantFormat::Mat),
            ] {
                assert_eq!(PlantFormat::of(name), Some(format));
                let back = of(name, &write(&system, format), None).map(|plant| plant.system);
                assert_eq!(state_space(back), system, "{name}, {n} states");
            }
        }
    }
}

#[test]
fn mat_files_of_scipy_are_read() {
    let sampled = motor(Time::Sampled(0.01));
    macro_rules! mat {
        ($name:literal) => {
            of(concat!($name, ".mat"), include_bytes!(concat!("../plants/", $name, ".mat")), None)
                .map(|plant| plant.system)
        };
    }
    for (name, file) in [
        ("plain", mat!("plain")),
        ("compressed", mat!("compressed")),
        ("four", mat!("four")),
        ("structure", mat!("structure")),
    ] {
        assert_eq!(state_space(file), sampled, "{name}");
    }
    let whole = state_space(mat!("whole"));
    assert_eq!(
        (whole.a()[(1, 1)], whole.c()[(0, 1)], whole.time()),
        (-3.0, f64::from(0.1_f32), Time::Continuous)
    );
    assert_eq!(transfer(mat!("transfer")).to_string(), "(s + 2) / (s² + 3 s + 2.5)");
    assert_eq!(transfer(mat!("cells")).to_string(), "(2 s + 1) / (s² + 0.5 s + 0.25)");
    assert_eq!(transfer(mat!("factors")).to_string(), "(4 s + 12) / (s² + 2 s + 5)");
    let Ok(PlantFile::Frequencies(data)) = mat!("response") else {
        panic!("no response: {:?}", mat!("response"))
    };
    assert_eq!(data.rad_s().len(), 12);
    assert!((complex::norm(data.values()[0]) - 1.0 / 1.01_f64.sqrt()).abs() < 1e-15);
}

/// A row of a first-order lag of 10 rad/s, its fields what a form names.
fn row(form: &str, w: f64) -> String {
    let value = 10.0 / Complex::new(10.0, w);
    let size = complex::norm(value);
    let decimal = |x: f64| {
        let text = format!("{x:?}");
        if form.contains(';') { text.replace('.', ",") } else { text }
    };
    let field = |word: &str| {
        let end = word.len() - usize::from(word.ends_with([',', ';', '\t', ' ']));
        let number = match &word[..end] {
            "w" => w,
            "hz" => w / std::f64::consts::TAU,
            "khz" => w / std::f64::consts::TAU / 1e3,
            "a" => size,
            "db" => 20.0 * log10(size),
            "d" => complex::arg(value).to_degrees(),
            "rad" => complex::arg(value),
            "re" => value.re,
            "im" => value.im,
            other => other.parse().unwrap(),
        };
        decimal(number) + &word[end..]
    };
    form.split_inclusive([',', ';', '\t', ' ']).map(field).collect()
}

/// A first-order lag of 10 rad/s at three frequencies, as programs and instruments write it.
#[test]
fn frequency_data_are_read_by_the_names_of_their_columns() {
    for (name, file, choice) in [
        (
            "lab.csv",
            "rad_s,magnitude_rad_per_v,phase_deg,coherence,deviation,model_magnitude,model_phase_deg\nROWS:w,a,d,1,0,9,9",
            None,
        ),
        ("bode.csv", "rad_s,magnitude_db_1,phase_deg_1\nROWS:w,db,d", None),
        (
            "bode.csv",
            "rad_s,magnitude_db_1,phase_deg_1,magnitude_db_2,phase_deg_2\nROWS:w,9,9,db,d",
            Some("2"),
        ),
        ("plain.csv", "Frequency (Hz), Gain (dB), Phase (deg)\nROWS:hz,db,d", None),
        ("parts.csv", "omega,real,imag\nROWS:w,re,im", None),
        ("parts.txt", "# freq_hz re im\nROWS:hz re im", None),
        (
            "keysight.csv",
            "#, Frequency (Hz), Amplitude (Vpp), Gain (dB), Phase (°)\nROWS:1,hz,0.4,db,d",
            None,
        ),
        ("european.csv", "Frequency in Hz;Gain in dB;Phase in °\nROWS:hz;db;d", None),
        (
            "siglent.csv",
            "Source,Sine\nLoad,50\n\nFrequency(Hz),CH2 Amplitude(dB),CH2 Phase(Deg)\nROWS:hz,db,d",
            None,
        ),
        (
            "waveforms.csv",
            "#Digilent WaveForms Network\n#Date: x\nFrequency (Hz),Channel 1 Magnitude (dB),Channel 2 Magnitude (dB),Channel 2 Phase (*)\nROWS:hz,9,db,d",
            None,
        ),
        (
            "bode100.csv",
            "Frequency (Hz),Trace 1: Gain: Magnitude (dB),Trace 1: Gain: Phase (°)\nROWS:hz,db,d",
            None,
        ),
        ("khz.tsv", "Frequency (kHz)\tMagnitude (abs)\tPhase (rad)\nROWS:khz\ta\trad", None),
        ("falling.csv", "Frequency (Hz), Gain (dB), Phase (deg)\nFALL:hz,db,d", None),
    ] {
        let (front, form) = file.rsplit_once('\n').unwrap();
        let mut rows: Vec<String> = [3.0, 10.0, 40.0].map(|w| row(&form[5..], w)).to_vec();
        if form.starts_with("FALL") {
            rows.reverse();
        }
        let file = format!("{front}\n{}\n", rows.join("\n"));
        for bytes in [
            file.clone().into_bytes(),
            file.chars().map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?')).collect(),
        ] {
            let plant = of(name, &bytes, choice).unwrap_or_else(|e| panic!("{e}\n{file}"));
            let PlantFile::Frequencies(data) = plant.system else { panic!("{name}") };
            for (w, value) in data.rad_s().iter().zip(data.values()) {
                assert!(
                    complex::norm(value * Complex::new(10.0, *w) - 10.0) < 1e-12,
                    "{name}: {value} at {w}"
                );
            }
            assert!(plant.understood.unwrap().contains("frequency"), "{name}");
        }
    }
}

#[test]
fn what_the_bench_prints_reads_as_it_stands() {
    let linearize = r#"{"A":[[0.0,1.0],[0.0,-0.5]],"B":[[0.0],[1.0]],"C":[[1.0,0.0]],"D":[[0.0]],"G11":{"cancelled":[],"den":[1.0,0.5,0.0],"num":[1.0]},"G22":{"cancelled":[],"den":[1.0,0.0,0.0],"num":[2.0]},"head":"x","poles":[[0.0,0.0]],"period_s":null}"#;
    assert_eq!(state_space(text("l.json", linearize)).order(), 2);
    let second = of("l.json", linearize.as_bytes(), Some("G22")).unwrap().system;
    assert_eq!(transfer(Ok(second)).to_string(), "2 / s²");
    let bode = r#"{"rad_s":[1.0,2.0],"systems":[{"name":"1/(s+1)","num":[1.0],"den":[1.0,1.0],"zeros":[],"poles":[[-1.0,0.0]],"magnitude_db":[-3.0,-7.0],"phase_deg":[-45.0,-63.0]},{"name":"z","period_s":0.1,"num":[1.0],"den":[1.0,0.5]}]}"#;
    let error = text("b.json", bode).unwrap_err();
    assert!(error.contains("2 systems: choose one of 1, 2"), "{error}");
    assert_eq!(
        transfer(of("b.json", bode.as_bytes(), Some("2")).map(|plant| plant.system)).time(),
        Time::Sampled(0.1)
    );
    assert_eq!(
        transfer(of("b.json", bode.as_bytes(), Some("1/(s+1)")).map(|plant| plant.system)).time(),
        Time::Continuous
    );
    let frequency = r#"{"axis":"pan","points":[{"rad_s":1.0,"magnitude":2.0,"phase_deg":-90.0,"coherence":1.0},{"rad_s":2.0,"magnitude":1.0,"phase_deg":-120.0,"coherence":1.0}]}"#;
    let PlantFile::Frequencies(data) = text("f.json", frequency).unwrap() else { panic!("no response") };
    assert!(complex::norm(data.values()[0] - Complex::new(0.0, -2.0)) < 1e-15);
}

#[test]
fn what_is_left_open_or_wrong_is_refused_with_its_place_and_what_to_do() {
    for (name, file, says) in [
        (
            "p.toml",
            "A = [[1, 2], [3]]\nB = [[1], [1]]\nC = [[1, 1]]\nD = [[0]]",
            "p.toml:1: row 2 of A has 1 numbers",
        ),
        ("p.toml", "A = [[1, 2]]\nB = [[1]]\nC = [[1, 1]]\nD = [[0]]", "A is 1 × 2; it has to be square"),
        ("p.toml", "A = [[1]]\nB = [[1], [2]]\nC = [[1]]\nD = [[0]]", "p.toml:2: B is 2 × 1; with 1 states"),
        ("p.toml", "A = [[1]]\nB = [[1]]\nC = [[1]]", "D is missing; where it is zero write D = 0"),
        ("p.toml", "A = [[nan]]\nB = [[1]]\nC = [[1]]\nD = 0", "p.toml:1: NaN"),
        ("p.toml", "A = [[1]\n", "p.toml:"),
        ("p.json", "{\"A\":[[1]],\n\"A\":2}", "p.json:2: \"A\" is there twice"),
        ("p.json", "{\"A\":[[NaN]]}", "\"NaN\" is no number"),
        ("p.json", "{\"x\":1}", "it describes no system"),
        ("p.json", "[1,2]", "no values by name"),
        ("p.json", "{\"num\":[1],\"den\":[1,1],\"dt\":-1}", "dt is -1: say how many seconds"),
        ("p.json", "{\"num\":[1],\"den\":[1,1],\"dt\":true}", "dt is true"),
        ("p.json", "{\"num\":[1],\"den\":[1,1],\"delay_s\":0.1}", "dead time is not read"),
        ("p.json", "{\"num\":[1],\"den\":[0]}", "a denominator is zero"),
        (
            "p.json",
            "{\"num\":[1],\"den\":[1,1],\"A\":[[1]],\"B\":[[1]],\"C\":[[1]],\"D\":0}",
            "describes a system twice",
        ),
        ("p.json", "{\"gain\":1,\"poles\":[[-1,2]]}", "has no conjugate"),
        ("p.json", "{\"A\":[[1]],\"B\":[[1]],\"C\":[[1]],\"D\":0,\"E\":[[2]]}", "E is not the identity"),
        ("p.csv", "A\n1,x\n", "p.csv:2: \"x\", column 2, below A"),
        (
            "f.csv",
            "Frequency,Gain (dB),Phase (deg)\n1,2,3\n",
            "f.csv:1: column \"Frequency\" has no unit: name it \"Frequency (Hz)\" or",
        ),
        ("f.csv", "Frequency (Hz),Gain,Phase (deg)\n1,2,3\n", "name it \"Gain (dB)\" or \"Gain (abs)\""),
        ("f.csv", "Frequency (Hz),Gain (dB),Phase\n1,2,3\n", "name it \"Phase (deg)\" or \"Phase (rad)\""),
        ("f.csv", "hz,gain (dB)\n1,2\n", "no columns are the values"),
        ("f.csv", "hz,db,deg\n1,2,3\n2,x,3\n", "f.csv:3: \"x\" in column 2 (db) is no number"),
        ("f.csv", "hz,db,deg\n1,2,3\n1,2,3\n", "point 2"),
        ("f.csv", "hz,db,deg\n", "at least two"),
        ("f.csv", "1,2,3\n4,5,6\n", "above the columns write names"),
        (
            "f.csv",
            "rad_s,magnitude_db_1,phase_deg_1,magnitude_db_2,phase_deg_2\n1,2,3,4,5\n",
            "choose one of \"1\", \"2\"",
        ),
        ("f.mat", "MATLAB 7.3 MAT-file", "save it with save(…, '-v7')"),
        ("f.mat", "nothing", "no .mat file"),
        ("f.xml", "", "ends in .toml"),
    ] {
        let error = text(name, file).unwrap_err();
        assert!(error.starts_with(name) && error.contains(says), "{file:?}\n{error}\nshould say {says}");
    }
}

#[test]
fn bounds_are_kept_before_work() {
    let rows = vec![format!("[{}]", vec!["0"; 201].join(",")); 201].join(",");
    let error = text("p.json", &format!("{{\"A\":[{rows}],\"B\":[[1]],\"C\":[[1]],\"D\":0}}")).unwrap_err();
    assert!(error.contains("at most 200 states"), "{error}");
    for (open, close) in [("[", "]"), ("{\"a\":", "}")] {
        let deep = format!("{{\"A\":{}1{}}}", open.repeat(100_000), close.repeat(100_000));
        assert!(text("p.json", &deep).unwrap_err().contains("nested"));
        assert!(text("p.toml", &format!("A = {}", "[".repeat(100_000))).is_err());
    }
    assert!(text("p.toml", &format!("{}a = 1", "a.".repeat(100_000))).is_err());
    let (column, row) = (vec!["[1]"; 100_000].join(","), vec!["1"; 100_000].join(","));
    let wide = format!("{{\"A\":[[1]],\"B\":[[{row}]],\"C\":[{column}],\"D\":0}}");
    assert!(text("p.json", &wide).unwrap_err().contains("from 1 to 32 of each"));
    assert!(text("f.csv", &",".repeat(10_000_000)).is_err());
    let long = vec!["1"; 202].join(",");
    assert!(
        text("p.json", &format!("{{\"num\":[1],\"den\":[{long}]}}")).unwrap_err().contains("at most 200")
    );
}

/// Cut, changed and mixed files of every kind end in a system or in a sentence.
#[test]
fn broken_files_end_in_a_sentence() {
    let rounds: u64 = std::env::var("PLANT_ROUNDS").ok().and_then(|text| text.parse().ok()).unwrap_or(3000);
    let system = motor(Time::Sampled(0.01));
    let seeds: [(&str, Vec<u8>); 10] = [
        ("p.toml", write(&system, PlantFormat::Toml)),
        ("p.json", write(&system, PlantFormat::Json)),
        ("p.csv", write(&system, PlantFormat::Csv)),
        ("p.mat", write(&system, PlantFormat::Mat)),
        ("p.mat", include_bytes!("../plants/compressed.mat").to_vec()),
        ("p.mat", include_bytes!("../plants/structure.mat").to_vec()),
        ("p.mat", include_bytes!("../plants/four.mat").to_vec()),
        ("p.mat", include_bytes!("../plants/cells.mat").to_vec()),
        ("f.csv", b"Frequency (Hz),Gain (dB),Phase (\xb0)\n1,2,3\n2,3,4\n5,6,7\n".to_vec()),
        (
            "g.json",
            br#"{"systems":[{"name":"a","gain":4,"zeros":[-3],"poles":["-1+2j","-1-2j"],"dt":0.1}]}"#
                .to_vec(),
        ),
    ];
    let mut random = oorandom::Rand64::new(36);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..rounds {
        for (name, seed) in &seeds {
            let mut bytes = seed.clone();
            for _ in 0..=random.rand_range(0..4) {
                let at = random.rand_range(0..bytes.len().max(1) as u64) as usize;
                match random.rand_range(0..5) {
                    0 => bytes.truncate(at),
                    1 if at < bytes.len() => bytes[at] = random.rand_range(0..256) as u8,
                    2 if at < bytes.len() => bytes[at] ^= 1 << random.rand_range(0..8),
                    3 if at < bytes.len() => drop(bytes.remove(at)),
                    _ => {
                        let piece = bytes[at.min(bytes.len())..(at + 9).min(bytes.len())].to_vec();
                        let to = random.rand_range(0..bytes.len() as u64 + 1) as usize;
                        bytes.splice(to..to, piece);
                    }
                }
            }
            match of(name, &bytes, None) {
                Ok(_) => read += 1,
                Err(message) => {
                    assert!(message.starts_with(name) && message.len() < 2000, "{message}");
                    refused += 1;
                }
            }
        }
    }
    assert!(read > rounds / 3 && refused > rounds, "{read} read, {refused} refused");
}
