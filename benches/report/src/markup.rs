//! A text of titles, paragraphs, tables and pictures, once as Markdown and once as a page of its own.

use super::svg::escape;

/// A piece of text.
pub(super) enum Block {
    Title(String),
    Heading(String),
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

/// Returns the text as Markdown; plots and pictures are linked.
pub(super) fn markdown(blocks: &[Block]) -> String {
    let mut text = String::new();
    for block in blocks {
        text += &match block {
            Block::Title(title) => format!("# {title}\n\n"),
            Block::Heading(heading) => format!("## {heading}\n\n"),
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

const STYLE: &str = "\
:root { color-scheme: light dark; }
body { font: 15px/1.45 sans-serif; max-width: 60rem; margin: 1.2rem auto; padding: 0 1rem; }
h1 { margin: 0 0 0.4rem; } h2 { margin-top: 2.4rem; } p { margin: 0.6rem 0; }
table { border-collapse: collapse; display: block; overflow-x: auto; margin: 0.8rem 0; font-size: 13px; }
th, td { border: 1px solid #8886; padding: 0.15rem 0.5rem; text-align: left; }
svg { max-width: 100%; height: auto; }
figure { display: inline-block; margin: 0 1rem 1rem 0; width: 45%; }
figure img { width: 100%; image-rendering: pixelated; }
code { overflow-wrap: anywhere; }
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
            Block::Heading(heading) => format!("<h2>{}</h2>\n", escape(heading)),
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
                let line = |row: &Vec<String>, cell: &str| {
                    let cells = row.iter().map(|text| format!("<{cell}>{}</{cell}>", bold(&escape(text))));
                    format!("<tr>{}</tr>\n", cells.collect::<String>())
                };
                let body: String = rows[1..].iter().map(|row| line(row, "td")).collect();
                format!("<table>\n{}{body}</table>\n", line(&rows[0], "th"))
            }
        };
    }
    text + "</html>\n"
}

/// Sets what is between pairs of asterisks in bold.
fn bold(text: &str) -> String {
    let parts = text.split("**").enumerate();
    parts.map(|(i, part)| if i % 2 == 1 { format!("<b>{part}</b>") } else { part.to_owned() }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_breaks_a_page() {
        let blocks = [
            Block::Paragraph("**Bold** is 1 < 2".into()),
            Block::Table(vec![vec!["a".into()], vec!["<b> & **|c|**".into()]]),
        ];
        let page = html(&blocks);
        assert!(page.contains("<p><b>Bold</b> is 1 &lt; 2</p>"), "{page}");
        assert!(page.contains("<td>&lt;b&gt; &amp; <b>|c|</b></td>"), "{page}");
        assert!(markdown(&blocks).ends_with("| <b> & **\\|c\\|** |\n"));
    }
}
