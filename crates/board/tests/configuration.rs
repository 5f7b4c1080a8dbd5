//! The controller's configuration as bytes, and what is no configuration.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use tracelight_board::{MOST_CONFIGURATION, law_hash, read_configuration, write_configuration};
use tracelight_control::Config;
use tracelight_rig::wire::WrongConfiguration;
use tracelight_sim::{LawName, ObserverName, RigConfig};

fn bytes(config: &Config) -> Vec<u8> {
    let mut out = [0xAA; MOST_CONFIGURATION];
    let length = write_configuration(config, &mut out).unwrap();
    out[..length].to_vec()
}

/// Every preset, by every law and every observer.
fn configs() -> Vec<Config> {
    let mut all = Vec::new();
    for rig in RigConfig::presets() {
        for law in LawName::ALL {
            for observer in ObserverName::ALL {
                let mut rig = rig.clone();
                rig.control.law = law;
                rig.control.observer = Some(observer);
                all.push(rig.control_config());
            }
        }
    }
    all
}

#[test]
fn every_configuration_comes_back_bit_for_bit() {
    let all = configs();
    assert!(all.len() > 20, "{}", all.len());
    for config in &all {
        assert_eq!(read_configuration(&bytes(config)).unwrap(), *config);
    }
    let lengths: Vec<usize> = all.iter().map(|config| bytes(config).len()).collect();
    println!("{} to {} bytes", lengths.iter().min().unwrap(), lengths.iter().max().unwrap());
}

#[test]
fn what_is_too_short_or_too_long_says_how_long_it_should_be() {
    let whole = bytes(&RigConfig::report().control_config());
    let length = WrongConfiguration::Length(whole.len() as u16);
    for short in 0..whole.len() {
        // of what ends in the middle of a choice only that much is known
        let error = read_configuration(&whole[..short]).unwrap_err();
        assert!(matches!(error, WrongConfiguration::Length(_)), "{short}: {error:?}");
    }
    let mut long = whole.clone();
    long.push(0);
    assert_eq!(read_configuration(&long).unwrap_err(), length);
    assert_eq!(read_configuration(&whole[..whole.len() - 1]).unwrap_err(), length);
}

#[test]
fn a_word_that_cannot_be_is_refused_by_its_number() {
    let whole = bytes(&RigConfig::report().control_config());
    let (mut refused, mut taken) = (0, 0);
    for word in 0..whole.len() / 4 {
        for bits in [f32::NAN.to_bits(), f32::INFINITY.to_bits(), u32::MAX, (-1.0_f32).to_bits()] {
            let mut wrong = whole.clone();
            wrong[4 * word..][..4].copy_from_slice(&bits.to_le_bytes());
            match read_configuration(&wrong) {
                Ok(config) => {
                    // a number that is negative, where it may be
                    assert_eq!(bits, (-1.0_f32).to_bits(), "word {word}");
                    assert_eq!(bytes(&config), wrong);
                    taken += 1;
                }
                Err(error) => {
                    assert_eq!(error, WrongConfiguration::Word { word: word as u16, bits });
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > 400 && taken > 10, "{refused} {taken}");
}

#[test]
fn another_law_has_another_hash() {
    let config = RigConfig::report().control_config();
    let hash = law_hash(&config);
    assert_eq!(hash, law_hash(&config));
    let mut other = config;
    other.axes.tilt.torque_nm_per_v = f32::from_bits(other.axes.tilt.torque_nm_per_v.to_bits() + 1);
    assert_ne!(hash, law_hash(&other), "a last digit that is another");
    let hashes: std::collections::BTreeSet<u32> = configs().iter().map(law_hash).collect();
    assert!(hashes.len() > 10, "{}", hashes.len());
}
