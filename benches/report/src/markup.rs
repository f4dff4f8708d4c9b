//! A text of titles, paragraphs, tables and pictures, once as Markdown and once as a page of its own.

use super::svg::escape;

/// A piece of text.
pub(super) enum Block {
    Title(String),
    Heading(String),
    /// Links to all headings, and to a page to try things on.
    Contents,
    Paragraph(String),
    /// The first row is the head.
    Table(Vec<Vec<String>>),
    /// A plot: its file's name, what it shows, and its SVG.
    Plot(String, String, String),
    /// Pictures side by side.
    Pictures(Vec<Picture>),
}

/// A picture, and what it shows.
pub(super) struct Picture {
    pub(super) file: String,
    pub(super) caption: String,
    /// The PNG in base64.
    pub(super) png: String,
}

/// The page with sliders, which stands beside the report.
const TRY: [&str; 2] = ["try it: sliders, a lens, your own numbers", "try.html"];

/// The headings and their anchors, made as GitHub makes them, and the page to try things on.
fn contents(blocks: &[Block]) -> Vec<[String; 2]> {
    let headings = blocks.iter().filter_map(|block| match block {
        Block::Heading(heading) => Some([heading.clone(), format!("#{}", anchor(heading))]),
        _ => None,
    });
    [TRY.map(str::to_owned)].into_iter().chain(headings).collect()
}

fn anchor(heading: &str) -> String {
    let kept = |c: char| match c {
        ' ' => Some('-'),
        _ => (c.is_alphanumeric() || c == '-').then(|| c.to_ascii_lowercase()),
    };
    heading.chars().filter_map(kept).collect()
}

/// Returns the text as Markdown; plots and pictures are linked.
pub(super) fn markdown(blocks: &[Block]) -> String {
    let mut text = String::new();
    for block in blocks {
        text += &match block {
            Block::Title(title) => format!("# {title}\n\n"),
            Block::Heading(heading) => format!("## {heading}\n\n"),
            Block::Contents => {
                let links: Vec<String> =
                    contents(blocks).iter().map(|[text, target]| format!("[{text}]({target})")).collect();
                links.join(" · ") + "\n\n"
            }
            Block::Paragraph(paragraph) => format!("{paragraph}\n\n"),
            Block::Plot(file, shows, _) => format!("![{shows}]({file})\n\n"),
            Block::Pictures(pictures) => {
                let row = |cell: &dyn Fn(&Picture) -> String| {
                    format!("| {} |\n", pictures.iter().map(cell).collect::<Vec<_>>().join(" | "))
                };
                let captions = row(&|picture| picture.caption.clone());
                let images = row(&|picture| format!("![{}]({})", picture.caption, picture.file));
                format!("{captions}{}{images}\n", row(&|_| "---".to_owned()))
            }
            Block::Table(rows) => {
                let line = |row: &Vec<String>| {
                    let cells: Vec<String> = row.iter().map(|cell| cell.replace('|', "\\|")).collect();
                    format!("| {} |\n", cells.join(" | "))
                };
                let rule = format!("|{}\n", " --- |".repeat(rows[0].len()));
                line(&rows[0]) + &rule + &rows[1..].iter().map(line).collect::<String>() + "\n"
            }
        };
    }
    text.truncate(text.trim_end().len());
    text + "\n"
}

// On a narrow screen each row of a table is a block of its own, and each cell says what it is.
const STYLE: &str = "\
:root { color-scheme: light dark; }
body { font: 15px/1.45 sans-serif; max-width: 68rem; margin: 1.2rem auto; padding: 0 0.6rem; }
h1 { margin: 0 0 0.4rem; } h2 { margin-top: 2.4rem; } p { margin: 0.6rem 0; }
nav { display: flex; flex-wrap: wrap; gap: 0.1rem 1rem; margin: 0.6rem 0; }
table { border-collapse: collapse; margin: 0.8rem 0; font-size: 13px; }
th, td { border: 1px solid #8886; padding: 0.15rem 0.5rem; text-align: left; overflow-wrap: anywhere; }
th, td:first-child { overflow-wrap: normal; }
svg { width: 100%; max-width: 34rem; height: auto; display: block; margin: 0.8rem 0; }
figure { display: inline-block; margin: 0 1rem 1rem 0; width: 45%; }
figure img { width: 100%; image-rendering: pixelated; }
@media (prefers-color-scheme: dark) { body { background: #16181c; } }
@media (max-width: 40rem) {
table, thead, tbody, tr, th, td { display: block; } th { border: 0; padding: 0; } th:not(:first-child) { display: none; }
tbody tr { border: 1px solid #8886; margin: 0.5rem 0; padding: 0.2rem 0.4rem; }
td { border: 0; padding: 0.05rem 0; }
td:first-child { font-weight: bold; }
td:not(:first-child)::before { content: attr(data-head) \": \"; opacity: 0.75; }
figure { margin: 0 0.3rem 0.6rem 0; width: 47%; }
}
";

/// Returns the text as one page with everything in it.
pub(super) fn html(blocks: &[Block]) -> String {
    let mut text = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>Speed against error</title>\n\
         <style>\n{STYLE}</style>\n"
    );
    for block in blocks {
        text += &match block {
            Block::Title(title) => format!("<h1>{}</h1>\n", escape(title)),
            Block::Heading(heading) => format!("<h2 id=\"{}\">{}</h2>\n", anchor(heading), escape(heading)),
            Block::Contents => {
                let links = contents(blocks);
                let link = |[text, target]: &[String; 2]| format!("<a href=\"{target}\">{}</a>", escape(text));
                format!("<nav>{}</nav>\n", links.iter().map(link).collect::<Vec<_>>().join("\n"))
            }
            Block::Paragraph(paragraph) => format!("<p>{}</p>\n", bold(&escape(paragraph))),
            Block::Plot(_, _, svg) => svg.clone(),
            Block::Pictures(pictures) => pictures
                .iter()
                .map(|Picture { caption, png, .. }| {
                    let caption = escape(caption);
                    format!(
                        "<figure><img src=\"data:image/png;base64,{}\" alt=\"{caption}\">\
                         <figcaption>{caption}</figcaption></figure>\n",
                        escape(png)
                    )
                })
                .collect(),
            Block::Table(rows) => {
                let head: String = rows[0].iter().map(|text| format!("<th>{}</th>", bold(&escape(text)))).collect();
                let body = rows[1..].iter().map(|row| {
                    let cells = row.iter().zip(&rows[0]).enumerate().map(|(i, (text, head))| {
                        let head = if i == 0 { String::new() } else { format!(" data-head=\"{}\"", escape(head)) };
                        format!("<td{head}>{}</td>", bold(&escape(text)))
                    });
                    format!("<tr>{}</tr>\n", cells.collect::<String>())
                });
                let body: String = body.collect();
                format!("<table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody>\n</table>\n")
            }
        };
    }
    text + "</html>\n"
}

/// Sets what is between pairs of asterisks in bold, and what is between backquotes as code.
fn bold(text: &str) -> String {
    let set = |text: &str, mark: &str, tag: &str| {
        let parts = text.split(mark).enumerate();
        let set = |(i, part)| if i % 2 == 1 { format!("<{tag}>{part}</{tag}>") } else { String::from(part) };
        parts.map(set).collect::<String>()
    };
    set(&set(text, "**", "b"), "`", "code")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_breaks_a_page() {
        let blocks = [
            Block::Paragraph("**Bold** is `1 < 2`".into()),
            Block::Contents,
            Block::Heading("Phong's light".into()),
            Block::Table(vec![vec!["a".into(), "\"b\"".into()], vec!["<b> & **|c|**".into(), "d".into()]]),
        ];
        let page = html(&blocks);
        assert!(page.contains("<p><b>Bold</b> is <code>1 &lt; 2</code></p>"), "{page}");
        assert!(page.contains("<td>&lt;b&gt; &amp; <b>|c|</b></td><td data-head=\"&quot;b&quot;\">d</td>"), "{page}");
        assert!(page.contains("<a href=\"#phongs-light\">Phong's light</a>"), "{page}");
        assert!(page.contains("<h2 id=\"phongs-light\">"), "{page}");
        let text = markdown(&blocks);
        assert!(text.contains("(try.html) · [Phong's light](#phongs-light)"), "{text}");
        assert!(text.ends_with("| <b> & **\\|c\\|** | d |\n"), "{text}");
    }
}
