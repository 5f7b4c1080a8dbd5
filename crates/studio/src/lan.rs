//! This computer on its network: its addresses, its certificate, and the codes that a phone's camera reads.

use std::fs;
use std::net::{IpAddr, Ipv4Addr};
use std::path::Path;
use std::sync::Arc;

use qrcode::QrCode;
use qrcode::render::{svg, unicode};
use sha2::{Digest as _, Sha256};
use tokio_rustls::TlsAcceptor;
use tokio_rustls::rustls::crypto::ring;
use tokio_rustls::rustls::pki_types::pem::PemObject as _;
use tokio_rustls::rustls::pki_types::{CertificateDer, PrivateKeyDer};
use tokio_rustls::rustls::{ServerConfig, version};
use tracelight_task::Failure;

/// The certificate and its key, in the studio's folder.
const CERTIFICATE: &str = "lan-certificate.pem";
const KEY: &str = "lan-key.pem";

/// The door for devices of the network.
#[derive(Clone, Debug)]
pub(crate) struct Lan {
    pub(crate) port: u16,
    /// Of the certificate: SHA-256, as browsers show it.
    pub(crate) fingerprint: String,
}

impl Lan {
    /// Where devices of the network find it, the likeliest address first.
    pub(crate) fn addresses(&self) -> Vec<String> {
        addresses().iter().map(|ip| format!("https://{}/", at(*ip, self.port))).collect()
    }
}

fn at(ip: IpAddr, port: u16) -> String {
    match ip {
        IpAddr::V4(ip) => format!("{ip}:{port}"),
        IpAddr::V6(ip) => format!("[{ip}]:{port}"),
    }
}

/// This computer's addresses on its networks, but for those that only it knows: private ones first, as a house's network has them.
fn addresses() -> Vec<IpAddr> {
    let all = if_addrs::get_if_addrs().unwrap_or_default();
    let mut found: Vec<IpAddr> =
        all.iter().filter(|one| !one.is_loopback()).map(if_addrs::Interface::ip).collect();
    // of the others browsers want to be told by which interface
    found.retain(|ip| matches!(ip, IpAddr::V4(ip) if !ip.is_link_local()));
    found.sort_by_key(|ip| !matches!(ip, IpAddr::V4(ip) if ip.is_private()));
    if found.is_empty() { vec![IpAddr::V4(Ipv4Addr::LOCALHOST)] } else { found }
}

/// This computer's names on its network, in small letters.
fn names() -> Vec<String> {
    let name =
        hostname::get().ok().and_then(|name| name.into_string().ok()).unwrap_or_default().to_lowercase();
    let short = name.split('.').next().unwrap_or_default();
    let all = [name.clone(), short.to_owned(), format!("{short}.local")];
    all.into_iter().filter(|name| !name.is_empty() && name != ".local").collect()
}

/// What devices speak to in private, by the certificate of the studio's folder, which is made once; and that one's fingerprint.
///
/// # Errors
/// `cannot-write`; `certificate` where the one that is there cannot be read.
pub(crate) fn private(folder: &Path) -> Result<(TlsAcceptor, String), Failure> {
    let (certificate, key) = (folder.join(CERTIFICATE), folder.join(KEY));
    if !certificate.exists() || !key.exists() {
        make(&certificate, &key)?;
    }
    let damaged = |why: &dyn std::fmt::Display| {
        let message = format!(
            "cannot use {} and {}: {why}; delete both, and they are made anew",
            certificate.display(),
            key.display()
        );
        Failure::failed("certificate", message)
    };
    let chain = CertificateDer::from_pem_file(&certificate).map_err(|e| damaged(&e))?;
    let key_der = PrivateKeyDer::from_pem_file(&key).map_err(|e| damaged(&e))?;
    let fingerprint: Vec<String> = Sha256::digest(&chain).iter().map(|byte| format!("{byte:02X}")).collect();
    let config = ServerConfig::builder_with_provider(Arc::new(ring::default_provider()))
        .with_protocol_versions(&[&version::TLS13, &version::TLS12])
        .map_err(|e| damaged(&e))?
        .with_no_client_auth()
        .with_single_cert(vec![chain], key_der)
        .map_err(|e| damaged(&e))?;
    Ok((TlsAcceptor::from(Arc::new(config)), fingerprint.join(":")))
}

/// Makes a certificate for this computer's names and addresses of today. Nobody but its user reads the key.
fn make(certificate: &Path, key: &Path) -> Result<(), Failure> {
    let broken = |e: rcgen::Error| Failure::failed("internal", format!("cannot make a certificate: {e}"));
    let known = names().into_iter().chain(addresses().into_iter().map(|ip| ip.to_string()));
    let mut asked = rcgen::CertificateParams::new(known.collect::<Vec<_>>()).map_err(broken)?;
    asked.distinguished_name.push(rcgen::DnType::CommonName, "Tracelight studio");
    let pair = rcgen::KeyPair::generate().map_err(broken)?;
    let made = asked.self_signed(&pair).map_err(broken)?;
    for (path, text) in [(key, pair.serialize_pem()), (certificate, made.pem())] {
        let put = put_private(path, &text);
        put.map_err(|e| Failure::failed("cannot-write", format!("cannot write {}: {e}", path.display())))?;
    }
    Ok(())
}

/// Writes a file that nobody else of this computer reads.
fn put_private(path: &Path, text: &str) -> std::io::Result<()> {
    // one that is there may be readable by others, and stays so when it is written over
    match fs::remove_file(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(e),
        _ => {}
    }
    let mut options = fs::OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    std::io::Write::write_all(&mut options.open(path)?, text.as_bytes())
}

/// A text as a code for cameras, black on white, as SVG.
pub(crate) fn code_svg(text: &str) -> Option<String> {
    let code = QrCode::new(text).ok()?;
    Some(code.render::<svg::Color<'_>>().min_dimensions(240, 240).quiet_zone(true).build())
}

/// Likewise for terminals, light on dark.
pub(crate) fn code_text(text: &str) -> Option<String> {
    use unicode::Dense1x2;
    let code = QrCode::new(text).ok()?;
    let render = code
        .render::<Dense1x2>()
        .dark_color(Dense1x2::Light)
        .light_color(Dense1x2::Dark)
        .quiet_zone(true)
        .build();
    Some(render)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_certificate_is_made_once_and_its_key_is_nobody_elses() {
        let dir = std::env::temp_dir().join(format!("tracelight-lan-{}", std::process::id()));
        fs::create_dir_all(&dir).unwrap();
        let (_, first) = private(&dir).unwrap();
        let (_, again) = private(&dir).unwrap();
        assert!(first == again && first.len() == 32 * 3 - 1, "{first}");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            assert_eq!(fs::metadata(dir.join(KEY)).unwrap().permissions().mode() & 0o777, 0o600);
        }
        fs::write(dir.join(KEY), "no key").unwrap();
        let Err(told) = private(&dir) else { panic!("a damaged key is taken") };
        assert!(told.message.contains("delete both"), "{}", told.message);
        fs::remove_dir_all(&dir).unwrap();
    }

    #[test]
    fn codes_are_drawn_and_addresses_are_those_of_browsers() {
        let address = Lan { port: 4461, fingerprint: String::new() }.addresses().remove(0);
        assert!(address.starts_with("https://") && address.ends_with(":4461/"), "{address}");
        assert!(code_svg(&address).unwrap().contains("<svg"));
        assert!(code_text(&address).unwrap().lines().count() > 10);
        assert_eq!(at("fd00::1".parse().unwrap(), 1), "[fd00::1]:1");
    }
}
