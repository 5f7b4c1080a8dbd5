//! Cameras, calibrations and rig files, as they are asked for.

use super::*;

#[test]
fn a_camera_is_looked_through_image_by_image() {
    run(async {
        let studio = studio("cameras");
        let (_, all) = studio.get("/api/v1/cameras").await;
        let all: Value = serde_json::from_slice(&all).unwrap();
        assert_eq!(all["cameras"][0]["id"], "sim");
        let mut last = 0;
        for _ in 0..3 {
            let (status, body) =
                studio.get(&format!("/api/v1/cameras/sim:house.png/look?after={last}")).await;
            let told: Value = serde_json::from_slice(&body).unwrap();
            assert_eq!((status, &told["markers"]), (StatusCode::OK, &json!([])), "{told}");
            assert!(told["number"].as_u64().unwrap() > last, "{told}");
            last = told["number"].as_u64().unwrap();
            let (status, image) = studio.get(told["image"].as_str().unwrap()).await;
            assert_eq!((status, image.as_slice()), (StatusCode::OK, &b"image"[..]));
        }
        // what draws over it has it for itself, by the camera's own flag
        let asked = r#"{"picture":"camera:sim:house.png","flags":{"distance":"3m"}}"#;
        let (status, plan) = studio.post("/api/v1/plans", asked).await;
        assert_eq!(status, StatusCode::OK, "{plan}");
        let command = studio.asked.recv().unwrap();
        assert!(
            command[1].starts_with("--camera=sim:") && command[1].ends_with("pictures/house.png"),
            "{command:?}"
        );
        assert_eq!(command[2], "--distance=3m");
        // a simulated one is there for everybody, and no image has the number of another
        let (_, body) = studio.get(&format!("/api/v1/cameras/sim:house.png/look?after={last}")).await;
        let told: Value = serde_json::from_slice(&body).unwrap();
        assert!(told["number"].as_u64().unwrap() > last, "{told}");
        // a number of a studio that was open before counts for nothing
        let (status, _) = studio.get("/api/v1/cameras/sim:house.png/look?after=123456789").await;
        assert_eq!(status, StatusCode::OK);
        // what opens a camera is nobody's but the studio's own pages', though it is read
        let request = Request::get("/api/v1/cameras/sim/look").header("host", "127.0.0.1:4460");
        let request = request.header("sec-fetch-site", "cross-site").body(Body::empty()).unwrap();
        assert_eq!(studio.send(request).await.0, StatusCode::FORBIDDEN);
    });
}

#[test]
fn no_other_file_or_device_of_this_computer_is_a_camera() {
    run(async {
        let studio = studio("no-cameras");
        for id in [
            "%2Fdev%2Fvideo0",
            "http:%2F%2Fx",
            "sim:..%2F..%2Fx.png",
            "sim:%2Fetc%2Fx.png",
            "video7",
            "sim:",
            "named",
        ] {
            let (status, _) = studio.get(&format!("/api/v1/cameras/{id}/look")).await;
            assert_eq!(status, StatusCode::BAD_REQUEST, "{id}");
            let asked = format!(r#"{{"picture":"camera:{}"}}"#, id.replace("%2F", "/"));
            let (status, _) = studio.post("/api/v1/plans", asked).await;
            assert_eq!(status, StatusCode::BAD_REQUEST, "{id}");
        }
        let (status, _) = studio.get("/api/v1/cameras/sim/look?calibration=..%2Fx.toml").await;
        assert_eq!(status, StatusCode::BAD_REQUEST);
        assert!(studio.asked.try_recv().is_err(), "nothing was done");
    });
}

#[test]
fn a_calibration_is_kept_by_its_name_and_what_it_replaces_lies_in_the_trash() {
    run(async {
        let studio = studio("calibrations");
        let asked = r#"{"of":"corners","name":"shed.toml","flags":{"size":"2m,1m","simulate":true}}"#;
        let (status, made) = studio.post("/api/v1/calibrations", asked).await;
        assert_eq!((status, &made["replaced"]), (StatusCode::OK, &Value::Null), "{made}");
        let command = studio.asked.recv().unwrap();
        assert_eq!(command[..4], ["calibrate", "corners", "--simulate", "--size=2m,1m"]);
        assert_eq!(
            made["command"],
            "tracelight calibrate corners --simulate --size=2m,1m --output=shed.toml"
        );
        assert_eq!(
            (&made["words"], &made["calibration"]["name"]),
            (&json!("file: shed.toml"), &json!("shed.toml"))
        );
        let (_, again) = studio.post("/api/v1/calibrations", asked).await;
        assert_eq!(again["replaced"], "shed.toml");
        assert!(
            studio.dir.join("heads/shed.toml").is_file()
                && studio.dir.join("trash/heads/shed.toml").is_file()
        );
        // it is chosen by its name
        while studio.asked.try_recv().is_ok() {}
        let (status, _) =
            studio.post("/api/v1/plans", r#"{"picture":"house.png","flags":{"head":"shed.toml"}}"#).await;
        assert_eq!(status, StatusCode::OK);
        assert!(studio.asked.recv().unwrap()[2].ends_with("heads/shed.toml"));
        for flags in [r#"{"head":"/etc/x.toml"}"#, r#"{"head":"worn"}"#, r#"{"calibration":"shed.toml"}"#] {
            let (status, _) =
                studio.post("/api/v1/plans", format!(r#"{{"picture":"house.png","flags":{flags}}}"#)).await;
            assert_eq!(status, StatusCode::BAD_REQUEST, "{flags}");
        }
        for asked in [
            r#"{"of":"corners","name":"../x.toml"}"#,
            r#"{"of":"corners","name":"x.toml","flags":{"angles":"/etc/passwd"}}"#,
            r#"{"of":"corners","name":"x.toml","camera":"sim"}"#,
            r#"{"of":"markers","name":"x.toml","camera":"/dev/video0"}"#,
            r#"{"of":"lens","name":"x.toml","pictures":["/etc/passwd"]}"#,
            r#"{"of":"lens","name":"x.toml","flags":{"output":"/tmp/x.toml"}}"#,
        ] {
            let (status, told) = studio.post("/api/v1/calibrations", asked).await;
            assert_eq!(status, StatusCode::BAD_REQUEST, "{asked}: {told}");
        }
        let (status, told) = studio.delete("/api/v1/calibrations/heads/shed.toml").await;
        assert_eq!((status, &told["in_trash"]), (StatusCode::OK, &json!("shed.toml~2")));
        let (status, _) = studio.delete("/api/v1/calibrations/pictures/house.png").await;
        assert_eq!(status, StatusCode::NOT_FOUND);
        let (status, _) = studio.post("/api/v1/trash/heads/shed.toml~2", "").await;
        assert_eq!(status, StatusCode::OK);
    });
}

#[test]
fn a_head_that_is_calibrated_is_the_one_that_the_studio_was_opened_for() {
    run(async {
        let head = crate::program::Head {
            draws_as: "/dev/x:own.toml".to_owned(),
            planned_as: "own.toml".to_owned(),
            is_at_port: true,
            is_real: true,
        };
        let studio = studio_of("own-head", Some(head));
        let asked = |rig: &str| {
            format!(r#"{{"of":"corners","name":"x.toml","flags":{{"simulate":true,"rig":"{rig}"}}}}"#)
        };
        assert_eq!(studio.post("/api/v1/calibrations", asked("")).await.0, StatusCode::OK);
        assert_eq!(studio.asked.recv().unwrap()[2..4], ["--simulate", "--rig=own.toml"]);
        while studio.asked.try_recv().is_ok() {}
        assert_eq!(studio.post("/api/v1/calibrations", asked("report")).await.0, StatusCode::OK);
        assert!(studio.asked.recv().unwrap().contains(&"--rig=report".to_owned()));
    });
}

#[test]
fn a_rig_file_that_was_changed_elsewhere_is_not_written_over() {
    run(async {
        let studio = studio("rig-files");
        let write = |toml: &str, before: Option<&str>| {
            let asked = json!({ "toml": toml, "before": before }).to_string();
            studio.put("/api/v1/rigs/garage.toml", asked)
        };
        assert_eq!(write("a", Some("")).await.0, StatusCode::OK);
        // another one of its name is no new one
        let (status, told) = write("b", Some("")).await;
        assert_eq!(status, StatusCode::CONFLICT, "{told}");
        assert!(told["error"]["message"].as_str().unwrap().contains("another name"), "{told}");
        assert_eq!(write("b", Some("a")).await.0, StatusCode::OK);
        let (status, told) = write("c", Some("a")).await;
        assert_eq!(status, StatusCode::CONFLICT);
        assert!(told["error"]["message"].as_str().unwrap().contains("changed elsewhere"), "{told}");
        assert_eq!(std::fs::read_to_string(studio.dir.join("rigs/garage.toml")).unwrap(), "b");
        // who does not ask replaces it
        assert_eq!(write("d", None).await.0, StatusCode::OK);
    });
}
