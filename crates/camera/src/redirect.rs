//! Where a camera may send on who asks it: to places of its own, and nowhere else. Who is let into a room's images was told one host.

/// Longest place that is told in a message, letters.
const LONGEST_TOLD: usize = 200;
/// The port of an address that names none.
const USUAL_PORT: u16 = 80;

/// The address that a redirect means (RFC 3986, §5.2), of whoever asked `from`, an `http://…`.
///
/// # Errors
/// Where it would go, if that is another host, or nothing that HTTP reads.
pub(crate) fn target(from: &str, to: &str) -> Result<String, String> {
    let to = to.split('#').next().unwrap_or_default();
    let (own, base) = parted(from.get("http://".len()..).unwrap_or_default());
    let told: String = to.chars().take(LONGEST_TOLD).collect();
    let rest = match scheme_of(to) {
        Some(scheme) if !scheme.eq_ignore_ascii_case("http") => {
            return Err(format!(
                "it redirects to {told}, and nothing but http:// on the same host is followed"
            ));
        }
        Some(scheme) => &to[scheme.len() + 1..],
        None => to,
    };
    let Some(other) = rest.strip_prefix("//") else {
        return Ok(format!("http://{own}{}", without_dots(&joined(base, rest))));
    };
    let (authority, path) = parted(other);
    let elsewhere = || {
        let host = parted_authority(own).0;
        format!(
            "it redirects to {told}, which is not on {host}: no other host is asked; if it may be, give --camera its address"
        )
    };
    let [(own_host, own_port), (host, port)] = [own, authority].map(parted_authority);
    let port = port.ok_or_else(elsewhere)?;
    if !host.eq_ignore_ascii_case(own_host) {
        return Err(elsewhere());
    }
    // a name and a password are for the port they were given for
    let to = if own_port == Some(port) { own.to_owned() } else { format!("{own_host}:{port}") };
    Ok(format!("http://{to}{}", without_dots(&joined("/", path))))
}

/// What an address begins with up to its first colon, if it is not a relative one.
fn scheme_of(address: &str) -> Option<&str> {
    let (scheme, _) = address.split_once(':')?;
    let is_letter = |c: char| c.is_ascii_alphanumeric() || "+-.".contains(c);
    (scheme.starts_with(|c: char| c.is_ascii_alphabetic()) && scheme.chars().all(is_letter)).then_some(scheme)
}

/// Host with port and name, and what is behind.
fn parted(address: &str) -> (&str, &str) {
    address.split_at(address.find(['/', '?', '#']).unwrap_or(address.len()))
}

/// Host and port; no port where it is no number.
fn parted_authority(authority: &str) -> (&str, Option<u16>) {
    let place = authority.rsplit_once('@').map_or(authority, |(_, place)| place);
    // colons within brackets are an address's own
    match place.rsplit_once(':').filter(|(_, port)| !port.contains(']')) {
        Some((host, "")) => (host, Some(USUAL_PORT)),
        Some((host, port)) => (host, port.parse().ok()),
        None => (place, Some(USUAL_PORT)),
    }
}

/// A path with its query, of one that is told relative to another.
fn joined(base: &str, to: &str) -> String {
    let base_path = base.split(['?', '#']).next().filter(|path| !path.is_empty()).unwrap_or("/");
    match to.chars().next() {
        None => base_path.to_owned(),
        Some('/') => to.to_owned(),
        Some('?') => format!("{base_path}{to}"),
        Some(_) => format!("{}{to}", &base_path[..=base_path.rfind('/').unwrap_or_default()]),
    }
}

/// A path without `.` and `..` (§5.2.4); its query stays.
fn without_dots(path: &str) -> String {
    let (path, query) = path.split_at(path.find('?').unwrap_or(path.len()));
    let mut kept = Vec::new();
    let parts: Vec<&str> = path.split('/').skip(1).collect();
    for part in &parts {
        match *part {
            "." => {}
            ".." => drop(kept.pop()),
            part => kept.push(part),
        }
    }
    if let Some(&("." | "..")) = parts.last() {
        kept.push("");
    }
    format!("/{}{query}", kept.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_redirect_within_a_host_is_followed() {
        for (from, to, wanted) in [
            ("http://cam/a/b?c", "/video", "http://cam/video"),
            ("http://cam/a/b?c", "video?x=1#y", "http://cam/a/video?x=1"),
            ("http://cam/a/b?c", "../video", "http://cam/video"),
            ("http://cam/a/b", "../../../etc/./x/..", "http://cam/etc/"),
            ("http://cam/a/b?c", "?d", "http://cam/a/b?d"),
            ("http://cam/a/b?c", "", "http://cam/a/b"),
            ("http://cam", "video", "http://cam/video"),
            ("http://cam?c", "video", "http://cam/video"),
            ("http://cam/a", "http://CAM", "http://cam/"),
            ("http://cam/a", "//cam?x", "http://cam/?x"),
            ("http://cam/a", "HTTP://cam:80/x", "http://cam/x"),
            ("http://cam/a", "http://cam:8080/x", "http://cam:8080/x"),
            ("http://me:secret@cam/a", "http://cam/x", "http://me:secret@cam/x"),
            ("http://me:secret@cam/a", "/x", "http://me:secret@cam/x"),
            ("http://me:secret@cam/a", "http://cam:81/x", "http://cam:81/x"),
            ("http://[::1]:8080/a", "http://[::1]:8080/x", "http://[::1]:8080/x"),
            ("http://[::1]/a", "//[::1]:/x", "http://[::1]/x"),
        ] {
            assert_eq!(target(from, to).as_deref(), Ok(wanted), "{from} to {to}");
        }
    }

    #[test]
    fn a_redirect_to_anywhere_else_is_refused_by_its_name() {
        for (from, to, what) in [
            ("http://cam/a", "http://other/x", "not on cam"),
            ("http://cam/a", "//other/x", "not on cam"),
            ("http://cam/a", "http://cam@other/x", "not on cam"),
            ("http://cam/a", "http://cam.other/x", "not on cam"),
            ("http://cam/a", "http://", "not on cam"),
            ("http://cam/a", "http://cam:port/x", "not on cam"),
            ("http://me:secret@cam/a", "http://other/x", "not on cam:"),
            ("http://[::1]/a", "http://[::2]/x", "not on [::1]"),
            ("http://cam/a", "https://cam/x", "nothing but http://"),
            ("http://cam/a", "file:///etc/passwd", "nothing but http://"),
            ("http://cam/a", "data:image/png;base64,AAAA", "nothing but http://"),
        ] {
            let why = target(from, to).unwrap_err();
            let goes = format!("it redirects to {to}, ");
            assert!(why.starts_with(&goes) && why.contains(what), "{from} to {to}: {why}");
            assert!(!why.contains("secret"), "{why}");
        }
        let long = target("http://cam/a", &format!("http://other/{}", "x".repeat(60_000))).unwrap_err();
        assert!(long.len() < 500, "{}", long.len());
    }
}
