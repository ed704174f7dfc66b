//! Names and bytes of files in messages.

/// Quoted names from a file for a message: the first few, and the number of the others.
pub fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    const MOST: usize = 8;
    let mut names = names.map(|name| quoted(name.as_bytes()));
    let mut text = names.by_ref().take(MOST).collect::<Vec<_>>().join(", ");
    match names.count() {
        0 => {}
        more => text += &format!(" and {more} more"),
    }
    text
}

/// Names as alternatives: `PLY, LAS or text`.
pub fn either(names: impl Iterator<Item = impl Into<String>>) -> String {
    let mut names: Vec<String> = names.map(Into::into).collect();
    let last = names.pop().unwrap_or_default();
    if names.is_empty() { last } else { format!("{} or {last}", names.join(", ")) }
}

/// Bytes of a file for a message: quoted, on one line, truncated.
pub fn quoted(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    let mut text = bytes[..bytes.len().min(LONGEST)].escape_ascii().to_string();
    if bytes.len() > LONGEST || text.len() > LONGEST {
        text.truncate(LONGEST);
        text.push('…');
    }
    format!("`{text}`")
}

/// A message of another library on one line, without control characters.
pub fn on_one_line(message: &str) -> String {
    message.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
