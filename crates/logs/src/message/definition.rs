//! Definitions of messages as ROS 2 writes them (`ros2msg`): fields in lines, then the kinds that
//! these use, each after a line of `=` and one with its name.

/// A field of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Field {
    pub(crate) name: String,
    pub(crate) kind: Kind,
}

/// What a field holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Number(Number),
    Text,
    /// Fields of its own.
    Group(Vec<Field>),
    /// An array of so many.
    Array(Box<Kind>, usize),
    /// An array with its length before it.
    Sequence(Box<Kind>),
}

/// Numbers, as they stand in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Number {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F32,
    F64,
}

/// What a message holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Definition {
    pub(crate) fields: Vec<Field>,
}

/// How deep kinds use kinds, and how many fields they have in all: definitions of files have fewer.
const DEEPEST: usize = 16;
const MOST_FIELDS: usize = 4096;

/// The longest definition \[bytes\].
const LONGEST: usize = 1 << 20;

impl Definition {
    /// Reads the definition of a kind, as `sensor_msgs/msg/JointState`. The error is a sentence.
    pub(crate) fn read(kind: &str, text: &[u8]) -> Result<Self, String> {
        if text.len() > LONGEST {
            return Err(format!("its definition has more than {LONGEST} bytes"));
        }
        let text = std::str::from_utf8(text).map_err(|_| "its definition is not UTF-8 text")?;
        let parts = Parts::new(kind, text);
        let mut left = MOST_FIELDS;
        let package = kind.split('/').next().unwrap_or_default();
        let fields = parts.fields(package, &parts.all[0].1, 0, &mut left)?;
        Ok(Self { fields })
    }
}

/// The lines of each kind, the message itself first.
struct Parts<'a> {
    all: Vec<(String, Vec<&'a str>)>,
}

/// `package/Name`, with or without `msg` between.
fn two_parts(kind: &str) -> String {
    kind.replace("/msg/", "/")
}

impl<'a> Parts<'a> {
    fn new(kind: &str, text: &'a str) -> Self {
        let mut all = vec![(two_parts(kind), Vec::new())];
        let mut begins = false;
        for line in text.lines().map(str::trim) {
            if line.len() >= 3 && line.bytes().all(|byte| byte == b'=') {
                begins = true;
            } else if let Some(name) = line.strip_prefix("MSG:").filter(|_| begins) {
                all.push((two_parts(name.trim()), Vec::new()));
                begins = false;
            } else if let Some((_, lines)) = all.last_mut() {
                lines.push(line);
            }
        }
        Self { all }
    }

    /// The fields of a kind, given by its package and lines.
    fn fields(
        &self,
        package: &str,
        lines: &[&str],
        depth: usize,
        left: &mut usize,
    ) -> Result<Vec<Field>, String> {
        if depth > DEEPEST {
            return Err("its definition uses itself, or too many others".to_owned());
        }
        let mut fields = Vec::new();
        for line in lines {
            let line = line.split('#').next().unwrap_or_default();
            let Some((kind, rest)) = line.trim().split_once(char::is_whitespace) else { continue };
            let rest = rest.trim();
            // constants are not in the bytes
            let name = rest.split_whitespace().next().unwrap_or_default();
            if rest.is_empty()
                || name.contains('=')
                || rest[name.len()..].trim_start().starts_with('=')
            {
                continue;
            }
            *left = left.checked_sub(1).ok_or("its definition has too many fields")?;
            let kind = self.kind(package, kind, depth, left)?;
            fields.push(Field { name: name.to_owned(), kind });
        }
        Ok(fields)
    }

    fn kind(
        &self,
        package: &str,
        text: &str,
        depth: usize,
        left: &mut usize,
    ) -> Result<Kind, String> {
        if let Some((of, length)) = text.strip_suffix(']').and_then(|text| text.rsplit_once('[')) {
            let of = Box::new(self.kind(package, of, depth, left)?);
            return match length.parse::<usize>() {
                Ok(length) => Ok(Kind::Array(of, length)),
                Err(_) if length.is_empty() || length.starts_with("<=") => Ok(Kind::Sequence(of)),
                Err(_) => Err(format!("its definition has an array `[{length}]`")),
            };
        }
        let number = match text {
            "bool" | "byte" | "char" | "uint8" => Number::U8,
            "int8" => Number::I8,
            "uint16" => Number::U16,
            "int16" => Number::I16,
            "uint32" => Number::U32,
            "int32" => Number::I32,
            "uint64" => Number::U64,
            "int64" => Number::I64,
            "float32" => Number::F32,
            "float64" => Number::F64,
            text if text == "string" || text.starts_with("string<=") => return Ok(Kind::Text),
            text => return self.group(package, text, depth, left),
        };
        Ok(Kind::Number(number))
    }

    fn group(
        &self,
        package: &str,
        text: &str,
        depth: usize,
        left: &mut usize,
    ) -> Result<Kind, String> {
        let name = match text {
            "Header" => "std_msgs/Header".to_owned(),
            text if text.contains('/') => two_parts(text),
            text => format!("{package}/{text}"),
        };
        let found = self.all.iter().find(|(known, _)| *known == name);
        let fields = match (found, name.as_str()) {
            (Some((name, lines)), _) => {
                let package = name.split('/').next().unwrap_or_default();
                self.fields(package, lines, depth + 1, left)?
            }
            (None, "builtin_interfaces/Time" | "builtin_interfaces/Duration") => time(),
            (None, _) => return Err(format!("its definition has `{text}`, which it does not say")),
        };
        Ok(Kind::Group(fields))
    }
}

/// A time or a duration, whose definition some files leave out.
fn time() -> Vec<Field> {
    [("sec", Number::I32), ("nanosec", Number::U32)]
        .map(|(name, number)| Field { name: name.to_owned(), kind: Kind::Number(number) })
        .into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_constants_comments_and_kinds_within_kinds_are_told_apart() {
        let text = "# a comment\nuint8 LEFT=1\nstring NAME = \"a b\"\n\
                    Header header\nPoint[3] at # m\n\
                    float32[<=4] some 1.5\nstring<=5 word\nbool[] bits\n\
                    ===\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
                    ===\nMSG: pkg/Point\nfloat64 x\nfloat64 y 0.5\n";
        let read = Definition::read("pkg/msg/Thing", text.as_bytes()).expect("a definition");
        let names: Vec<&str> = read.fields.iter().map(|field| field.name.as_str()).collect();
        assert_eq!(names, ["header", "at", "some", "word", "bits"]);
        let number = |number| Box::new(Kind::Number(number));
        assert_eq!(read.fields[2].kind, Kind::Sequence(number(Number::F32)));
        assert_eq!(read.fields[3].kind, Kind::Text);
        assert_eq!(read.fields[4].kind, Kind::Sequence(number(Number::U8)));
        let Kind::Array(point, 3) = &read.fields[1].kind else { panic!("{:?}", read.fields[1]) };
        assert!(matches!(&**point, Kind::Group(fields) if fields.len() == 2));
    }

    #[test]
    fn definitions_that_do_not_end_or_do_not_begin_are_refused() {
        let read = |text: &str| Definition::read("a/msg/A", text.as_bytes());
        assert!(read("A self\n").unwrap_err().contains("itself"));
        assert!(read("other/Kind x\n").unwrap_err().contains("other/Kind"));
        assert!(read("float64[x] y\n").is_err());
        assert!(read("wstring y\n").is_err());
        let double = |n: usize| format!("===\nMSG: a/K{n}\nK{0} x\nK{0} y\n", n + 1);
        let many: String = "K0 x\n".to_owned() + &(0..15).map(double).collect::<String>();
        assert!(read(&many).is_err());
    }
}
