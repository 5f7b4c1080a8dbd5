/// Text with `***` in place of the passwords in its addresses, such as `http://me:***@camera/video`, as messages and results show it.
#[must_use]
pub fn shown(text: &str) -> String {
    const MARK: &str = "://";
    let mut parts = text.split(MARK);
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c: char| c.is_whitespace() || "/?#\"'".contains(c)).unwrap_or(part.len());
        out.push_str(MARK);
        // a password may hold an @ itself
        match part[..end].rsplit_once('@').and_then(|(user, _)| Some((user.len(), user.split_once(':')?.0))) {
            Some((length, name)) => {
                out.push_str(name);
                out.push_str(":***");
                out.push_str(&part[length..]);
            }
            None => out.push_str(part),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_password_is_not_shown_and_all_else_is() {
        assert_eq!(shown("http://me:secret@cam:81/a?b=c@d"), "http://me:***@cam:81/a?b=c@d");
        assert_eq!(shown("http://me:sec@ret@cam"), "http://me:***@cam");
        let told = "cannot read http://u:p@cam/x, nor http://v:q@cam: no such file";
        assert_eq!(shown(told), "cannot read http://u:***@cam/x, nor http://v:***@cam: no such file");
        for whole in
            ["http://cam:81/a:b@c", "http://me@cam", "/dev/video0", "sim:a.png", "http://[::1]:8080/x", ""]
        {
            assert_eq!(shown(whole), whole);
        }
    }
}
