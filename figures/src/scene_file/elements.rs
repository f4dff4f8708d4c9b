//! Cuts a long scene into pieces that are parsed one after the other.
//!
//! A parsed table takes some thirty times the memory of its text, which is nothing for a scene written by hand and
//! gigabytes for a million lights written by a program. Such a scene consists of `[[light]]`, `[[sphere]]` and
//! `[[triangle]]` tables. They are cut out in groups, at the tables' headers, as the lexer of the TOML parser sees
//! them: brackets in strings, comments and arrays of several lines are no headers.

use std::ops::Range;

use toml_parser::Source;
use toml_parser::lexer::TokenKind;

/// The arrays of tables that are cut out.
const NAMES: [&str; 3] = ["light", "sphere", "triangle"];

/// A text without its elements, and where they are.
pub(super) struct Sections {
    /// The text with spaces in place of the elements, so that all else keeps its place.
    pub(super) rest: String,
    /// The elements in groups, in order; each of these ranges of the text is a document of its own.
    pub(super) groups: Vec<Range<usize>>,
}

/// Cuts the elements out of a scene, in groups of about `group` bytes; nothing is checked.
///
/// `None` if an element is written as a value (`light = [..]`): TOML refuses that beside tables of the same name, which
/// only a parser of the whole text can see.
pub(super) fn cut(text: &str, group: usize) -> Option<Sections> {
    let mut groups: Vec<Range<usize>> = Vec::new();
    // The last header, and which element it belongs to.
    let mut section: Option<(usize, Option<&str>)> = None;
    let mut depth = 0usize;
    // Whether a header or a key comes next: only between values.
    let mut between = true;
    for token in Source::new(text).lex() {
        let (at, end) = (token.span().start(), token.span().end());
        let kind = token.kind();
        let header = between && kind == TokenKind::LeftSquareBracket;
        if header || kind == TokenKind::Eof {
            if let Some((start, Some(_))) = section {
                match groups.last_mut() {
                    Some(last) if last.end == start && last.len() < group => last.end = at,
                    _ => groups.push(start..at),
                }
            }
            section = Some((at, element(&text[at..], section.and_then(|(_, element)| element))));
        }
        let key = between && matches!(kind, TokenKind::Atom | TokenKind::BasicString | TokenKind::LiteralString);
        if key && section.is_none() && NAMES.contains(&text[at..end].trim_matches(['"', '\''])) {
            return None;
        }
        match kind {
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => depth += 1,
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => depth = depth.saturating_sub(1),
            _ => {}
        }
        between = match kind {
            TokenKind::Whitespace | TokenKind::Comment => between,
            TokenKind::Newline => depth == 0,
            _ => false,
        };
    }
    let mut rest = Vec::from(text);
    for range in &groups {
        rest[range.clone()].fill(b' ');
    }
    // Headers begin at characters, and so the ranges do.
    Some(Sections { rest: String::from_utf8(rest).ok()?, groups })
}

/// The element to which a section belongs whose header starts `text`, after a section of the element `current`.
fn element<'a>(text: &'a str, current: Option<&'a str>) -> Option<&'a str> {
    let line = text.lines().next()?;
    let opened = line.strip_prefix("[[").and_then(|line| line.split_once("]]")).map(|(name, _)| name.trim());
    let part = || line.trim_start_matches('[').split_once('.').map(|(name, _)| name.trim());
    opened.filter(|name| NAMES.contains(name)).or_else(|| current.filter(|&current| part() == Some(current)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The groups' texts.
    fn groups(text: &str, group: usize) -> Vec<&str> {
        let Sections { rest, groups } = cut(text, group).unwrap();
        assert_eq!(rest.len(), text.len());
        let kept = (0..text.len()).filter(|at| !groups.iter().any(|range| range.contains(at)));
        assert!(kept.into_iter().all(|at| rest.as_bytes()[at] == text.as_bytes()[at]));
        groups.into_iter().map(|range| &text[range]).collect()
    }

    #[test]
    fn elements_are_cut_out_and_all_else_stays() {
        let text = "background = [0, 0, 0]\n[[light]]\na = 1\n[[ sphere ]] # ball\nb = 2\n[light]\n[camera]\n[[light]]";
        assert_eq!(groups(text, 1), ["[[light]]\na = 1\n", "[[ sphere ]] # ball\nb = 2\n", "[[light]]"]);
        assert_eq!(groups(text, 100), ["[[light]]\na = 1\n[[ sphere ]] # ball\nb = 2\n", "[[light]]"]);
        assert_eq!(
            groups("[[light]]\n[light.more]\n[[light.most]]\n[lights.x]", 1),
            ["[[light]]\n", "[light.more]\n", "[[light.most]]\n"]
        );
        assert_eq!(groups("[[mesh]]\nfile = \"a\"", 1), [""; 0]);
    }

    #[test]
    fn what_only_looks_like_a_header_is_none() {
        for text in [
            "a = \"\"\"\n[[light]]\n\"\"\"",
            "a = '''\n[[light]]\n'''",
            "a = [\n[[light]]\n]",
            "a = [ # ]\n[[light]]\n]",
            "a = [\"]\",\n[[light]]\n]",
            "# a\n# [[light]]",
            "a = {\n[[light]]\n}",
        ] {
            assert_eq!(groups(text, 1), [""; 0], "{text}");
        }
        let text = "[[triangle]]\ncolors = [\n[1, 0, 0],\n[0, 1, 0], [0, 0, 1]]\n[[triangle]]";
        assert_eq!(groups(text, 1).len(), 2);
    }

    #[test]
    fn elements_as_values_are_left_to_the_parser() {
        for text in ["light = []\n[[light]]", "a = 1\n\"sphere\" = 2", "'triangle'=[]"] {
            assert!(cut(text, 1).is_none(), "{text}");
        }
        assert!(cut("a = 1\n[material.x]\nlight = 1", 1).is_some());
    }
}
