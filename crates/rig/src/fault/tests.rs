//! What logs, wires and scripts know of faults stays as it is.

use super::*;

/// What wires and scripts know. A row may be added at the end; none may change, and who takes a fault out leaves its number here, alone.
const GOLDEN: &[(u8, &str)] = &[
    (1, "encoder-jumped"),
    (2, "encoder-dead"),
    (3, "encoder-noisy"),
    (4, "encoder-slipping"),
    (5, "setpoints-stale"),
    (6, "setpoint-invalid"),
    (7, "limit-reached"),
    (8, "hold-timed-out"),
    (9, "amplifier-saturated"),
    (10, "motor-hot"),
    (11, "laser-stuck"),
    (12, "host-lost"),
    (13, "estimate-diverged"),
    (14, "not-a-number"),
    (15, "emergency-stop"),
    (16, "interlock-open"),
    (17, "key-off"),
    (18, "amplifier-fault"),
    (19, "supply-low"),
    (20, "too-hot"),
    (21, "tick-late"),
    (22, "light-stood"),
    (23, "encoder-scale"),
    (24, "bumped"),
    (25, "laser-dark"),
    (26, "board-reset"),
    (27, "twin-diverged"),
    (28, "link-lost"),
];

#[test]
fn numbers_and_codes_are_those_that_wires_and_scripts_know() {
    let now = Fault::TABLE.map(|row| (row.number, row.code));
    assert_eq!(now, GOLDEN);
}

#[test]
fn every_fault_has_one_row_with_a_number_and_a_code_of_its_own() {
    for fault in Fault::ALL {
        assert_eq!(Fault::TABLE.iter().filter(|row| row.fault == fault).count(), 1, "{fault:?}");
        assert_eq!((fault.row().fault, fault.row().number), (fault, fault.number()));
        assert_eq!(Fault::from_number(fault.number()), Some(fault));
        assert_eq!(Fault::from_code(fault.code()), Some(fault));
        assert_eq!(fault.leaves_motors_blind(), fault.row().motors == Motors::Off, "{fault:?}");
        assert_eq!(fault.loses_counts(), fault.row().loses_counts, "{fault:?}");
    }
    assert_eq!((Fault::from_number(0), Fault::from_code("")), (None, None));
}

#[test]
fn what_loses_counts_is_not_armed_before_the_head_is_found() {
    for row in Fault::TABLE {
        assert_eq!(row.loses_counts, row.clears == Clears::FoundAndArmed, "{}", row.code);
        // a host can tell a board to be dark and no more
        let is_hosts = matches!(row.fault, Fault::TwinDiverged | Fault::LinkLost);
        assert!(!row.loses_counts || row.motors == Motors::Off || is_hosts, "{}", row.code);
    }
}
