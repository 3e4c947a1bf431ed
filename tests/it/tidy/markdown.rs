//! What tests of documents need of Markdown: links, headings, sentences, cells.

/// The lines of a page that are no code and no comment, with their numbers from 1.
pub(super) fn prose(page: &str) -> Vec<(usize, &str)> {
    let (mut lines, mut is_code, mut is_comment) = (Vec::new(), false, false);
    for (number, line) in (1..).zip(page.lines()) {
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
            lines.push((number, ""));
        } else if !is_code {
            is_comment |= line.starts_with("<!--");
            lines.push((number, if is_comment { "" } else { line }));
            is_comment &= !line.contains("-->");
        }
    }
    lines
}

/// Text without what stands between single backticks; a word stands in its place.
pub(super) fn without_code(text: &str) -> String {
    let pieces: Vec<&str> = text.split('`').collect();
    let is_paired = pieces.len() % 2 == 1;
    let piece = |(index, piece): (usize, &&str)| match index % 2 == 1 && is_paired {
        true => "CODE".to_owned(),
        false => (*piece).to_owned(),
    };
    pieces.iter().enumerate().map(piece).collect()
}

/// The targets of links and pictures, with the numbers of their lines.
pub(super) fn links(page: &str) -> Vec<(usize, String)> {
    let mut links = Vec::new();
    for (number, line) in prose(page) {
        for rest in line.split("](").skip(1) {
            let target = rest.split(')').next().unwrap_or_default();
            links.push((number, target.to_owned()));
        }
    }
    links
}

/// The anchors of a page's headings, as GitHub and mdBook make them.
pub(super) fn anchors(page: &str) -> Vec<String> {
    let headings = prose(page).into_iter().filter_map(|(_, line)| {
        let title = line.trim_start_matches('#');
        (title.len() < line.len()).then(|| title.trim().to_lowercase())
    });
    let kept = |c: &char| c.is_alphanumeric() || [' ', '-', '_'].contains(c);
    headings.map(|title| title.chars().filter(kept).collect::<String>().replace(' ', "-")).collect()
}

/// The paragraphs and items of lists; tables, headings and indented code are none.
fn paragraphs(page: &str) -> Vec<String> {
    let (mut all, mut open) = (Vec::new(), String::new());
    for (_, line) in prose(page) {
        let text = line.trim();
        let is_code = line.starts_with("    ") && open.is_empty();
        let ends = text.is_empty() || is_code || text.starts_with(['#', '|', '!']);
        let item = ["- ", "> ", ": "].iter().find_map(|mark| text.strip_prefix(mark));
        let numbered = text.split_once(". ").filter(|(number, _)| number.parse::<u32>().is_ok());
        let item = item.or(numbered.map(|(_, rest)| rest));
        if (ends || item.is_some()) && !open.is_empty() {
            all.push(std::mem::take(&mut open));
        }
        if !ends {
            open += item.unwrap_or(text);
            open.push(' ');
        }
    }
    all.push(open);
    all
}

fn words(text: &str) -> usize {
    text.split_whitespace().filter(|word| word.contains(char::is_alphanumeric)).count()
}

/// The number of words of each sentence. A colon ends none.
pub(super) fn sentences(page: &str) -> Vec<usize> {
    let mut lengths = Vec::new();
    for paragraph in paragraphs(page) {
        let mut text = String::new();
        // of a link its text counts
        for (index, piece) in without_code(&paragraph).split("](").enumerate() {
            text += match index {
                0 => piece,
                _ => piece.split_once(')').map_or("", |(_, rest)| rest),
            };
        }
        let mut length = 0;
        for word in text.split_whitespace() {
            length += words(word);
            let end = word.trim_end_matches([')', '"', '*', ']']);
            if end.ends_with(['.', '!', '?']) {
                lengths.extend(Some(length).filter(|&length| length > 0));
                length = 0;
            }
        }
        lengths.extend(Some(length).filter(|&length| length > 0));
    }
    lengths
}

/// The number of words of each cell of a table, with the number of its line.
pub(super) fn cells(page: &str) -> Vec<(usize, usize)> {
    let rows = prose(page).into_iter().filter(|(_, line)| line.trim_start().starts_with('|'));
    let cells = |(number, line): (usize, &str)| {
        let line = line.replace("\\|", " ");
        line.split('|').map(|cell| (number, words(cell))).collect::<Vec<_>>()
    };
    rows.flat_map(cells).collect()
}

#[test]
fn sentences_cells_links_and_anchors_are_counted() {
    let page = "# One, `two`: three\n\nA first sentence. And `a b c` is one word: (too.)\n\
                Last one [with a link](x.md#y)\n\n- an item\n\n```sh\nno words here.\n```\n\n\
                | a b | c \\| d |\n|---|---|\n    code\n";
    assert_eq!(sentences(page), [3, 6, 5, 2]);
    assert_eq!(cells(page).iter().map(|(_, words)| *words).max(), Some(2));
    assert_eq!(links(page), [(4, "x.md#y".to_owned())]);
    assert_eq!(anchors(page), ["one-two-three"]);
}
