//! What is behind every door.

use std::sync::Arc;

use axum::extract::FromRef;

use crate::desk::Desk;
use crate::devices::Devices;
use crate::lan::Lan;

/// Everything that those who ask are answered from.
#[derive(Clone)]
pub(crate) struct House {
    pub(crate) desk: Arc<Desk>,
    pub(crate) devices: Arc<Devices>,
    /// The door for devices of the network, where there is one.
    pub(crate) lan: Option<Arc<Lan>>,
}

impl FromRef<House> for Arc<Desk> {
    fn from_ref(house: &House) -> Self {
        Self::clone(&house.desk)
    }
}

impl FromRef<House> for Arc<Devices> {
    fn from_ref(house: &House) -> Self {
        Self::clone(&house.devices)
    }
}

impl FromRef<House> for Option<Arc<Lan>> {
    fn from_ref(house: &House) -> Self {
        house.lan.clone()
    }
}
