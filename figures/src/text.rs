//! Text from outside: byte-order marks at its start, and control characters in messages that quote it.

use std::borrow::Cow;
use std::path::Path;

/// A file in UTF-16, known by its byte-order mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("UTF-16 text; save it as UTF-8")]
pub(crate) struct Utf16;

/// Returns a file without the byte-order mark that it may start with.
///
/// # Errors
/// The mark is that of UTF-16.
pub(crate) fn without_mark(start: &[u8]) -> Result<&[u8], Utf16> {
    match start {
        [0xef, 0xbb, 0xbf, text @ ..] => Ok(text),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Err(Utf16),
        text => Ok(text),
    }
}

/// Returns a text that is safe to print on a terminal: control characters, and those that change the direction of
/// writing, are escaped as Rust escapes them.
pub(crate) fn escaped(text: &str) -> Cow<'_, str> {
    let turns =
        |c: char| matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let harmless = |c: char| !c.is_control() && !turns(c);
    if text.chars().all(harmless) {
        return Cow::Borrowed(text);
    }
    let escape = |c: char| if harmless(c) { c.to_string() } else { c.escape_default().to_string() };
    Cow::Owned(text.chars().map(escape).collect())
}

/// Returns a file's name for a message.
pub(crate) fn file_name(path: &Path) -> String {
    escaped(&path.to_string_lossy()).into_owned()
}

/// Returns the names of a list for a message, quoted: some of them, and how many more there are.
pub(crate) fn listed<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    const SHOWN: usize = 8;
    let more = names.len().saturating_sub(SHOWN);
    let mut text = names.take(SHOWN).map(quoted).collect::<Vec<_>>().join(", ");
    if more > 0 {
        text += &format!(" and {more} more");
    }
    text
}

/// Returns a name in quotes, escaped, and cut where it is long.
pub(crate) fn quoted(name: &str) -> String {
    match name.char_indices().nth(60) {
        Some((at, _)) => format!("{:?}...", &name[..at]),
        None => format!("{name:?}"),
    }
}

/// Returns the name that was probably meant: the first of those with the fewest slips, at most one for every two
/// letters.
///
/// A slip is a letter too many, missing, wrong, or swapped with the next (the restricted Damerau distance). Names of
/// more than 40 letters are not compared.
pub(crate) fn meant<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let is_short = |name: &str| name.chars().nth(40).is_none();
    let most = name.chars().count() / 2;
    let known = known.filter(|known| is_short(name) && is_short(known));
    let slips = known.map(|known| (strsim::osa_distance(name, known), known));
    slips.filter(|&(slips, _)| slips <= most).min_by_key(|&(slips, _)| slips).map(|(_, known)| known)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_passed_over_or_refused() {
        assert_eq!(without_mark(b"\xef\xbb\xbfv 0"), Ok(&b"v 0"[..]));
        assert_eq!(without_mark(b"\xef\xbbv"), Ok(&b"\xef\xbbv"[..]));
        assert_eq!((without_mark(b"\xff\xfev\0"), without_mark(b"\xfe\xff\0v")), (Err(Utf16), Err(Utf16)));
        assert_eq!(without_mark(b""), Ok(&b""[..]));
    }

    #[test]
    fn control_characters_are_escaped_and_nothing_else() {
        assert_eq!(escaped("\u{1b}[2J\r\n\t\0\u{7f}\u{9b}1A\u{202e}"), r"\u{1b}[2J\r\n\t\u{0}\u{7f}\u{9b}1A\u{202e}");
        // Text in any script stays, and so does a quote or a backslash.
        let plain = r#"Größe 大きさ "a\b" × ½"#;
        assert_eq!(escaped(plain), plain);
        let all: String = (0..=0x0010_ffff_u32).filter_map(char::from_u32).collect();
        assert!(!escaped(&all).contains(char::is_control));
    }

    #[test]
    fn long_lists_and_names_are_cut() {
        let names: Vec<String> = (0..100_000).map(|k| format!("m{k}")).collect();
        let text = listed(names.iter().map(String::as_str));
        assert_eq!(text, r#""m0", "m1", "m2", "m3", "m4", "m5", "m6", "m7" and 99992 more"#);
        assert_eq!(listed(["a\n", "b"].into_iter()), r#""a\n", "b""#);
        assert_eq!(quoted(&"x".repeat(100)).len(), 65);
    }

    #[test]
    fn the_name_with_the_fewest_slips_is_meant() {
        let known = ["red", "green", "gray", "grey", "blue"];
        let meant = |name| meant(name, known.into_iter());
        assert_eq!(meant("rde"), Some("red"));
        assert_eq!(meant("gren"), Some("green"));
        assert_eq!(meant("grray"), Some("gray"));
        assert_eq!(meant("blau"), Some("blue"));
        assert_eq!((meant("yellow"), meant(""), meant("x"), meant(&"r".repeat(1000))), (None, None, None, None));
    }
}
