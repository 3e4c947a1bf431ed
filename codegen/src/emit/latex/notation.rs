//! How symbols, angles and plain words are written.

use crate::expr::{Dag, ExprId, Node, SymbolClass, SymbolId};
use crate::function::force_name;
use crate::model::{Robot, Role};
use rustc_hash::FxHashMap;

/// Greek letters by the names that people type for them.
const GREEK: [(&str, &str); 27] = [
    ("alpha", r"\alpha"),
    ("beta", r"\beta"),
    ("gamma", r"\gamma"),
    ("delta", r"\delta"),
    ("epsilon", r"\varepsilon"),
    ("zeta", r"\zeta"),
    ("eta", r"\eta"),
    ("theta", r"\theta"),
    ("th", r"\theta"),
    ("kappa", r"\kappa"),
    ("lambda", r"\lambda"),
    ("mu", r"\mu"),
    ("nu", r"\nu"),
    ("xi", r"\xi"),
    ("rho", r"\rho"),
    ("sigma", r"\sigma"),
    ("tau", r"\tau"),
    ("phi", r"\varphi"),
    ("chi", r"\chi"),
    ("psi", r"\psi"),
    ("omega", r"\omega"),
    ("Gamma", r"\Gamma"),
    ("Delta", r"\Delta"),
    ("Phi", r"\Phi"),
    ("Psi", r"\Psi"),
    ("Omega", r"\Omega"),
    ("Lambda", r"\Lambda"),
];

/// The notation of one document: a person's names for symbols, and numbers for joints.
#[derive(Clone, Debug, Default)]
pub struct Notation {
    symbols: FxHashMap<SymbolId, String>,
    joints: FxHashMap<SymbolId, usize>,
    /// Whether the sine of joint angle 1 is `s_1`: not if a parameter looks like that.
    abbreviates: bool,
    /// The letter of intermediates, which no symbol has.
    letter: char,
}

impl Notation {
    /// After the names of the graph's symbols alone; joint j is the configuration whose name ends
    /// in the number j.
    pub fn of_names(dag: &Dag) -> Self {
        let mut notation = Self::default();
        for (id, symbol) in dag.symbols().iter() {
            notation.symbols.insert(id, latex_of_name(&symbol.name, symbol.class));
            let digits = symbol.name.trim_start_matches(|c: char| !c.is_ascii_digit());
            if symbol.class == SymbolClass::Configuration
                && let Ok(number) = digits.parse()
            {
                notation.joints.insert(id, number);
            }
        }
        notation.settled(dag)
    }

    /// After the robot: the j-th moving joint has `q_j`, its link has `m_j`, `I_{xx,j}` and so on;
    /// what belongs to a link that does not move bears its name.
    pub fn of_robot(dag: &Dag, robot: &Robot) -> Self {
        let mut notation = Self::of_names(dag);
        notation.joints.clear();
        let mut numbers = FxHashMap::default();
        for (row, (link, variables)) in robot.joints().enumerate() {
            let number = row + 1;
            numbers.insert(link, number.to_string());
            for (expr, base) in [
                (variables.q, "q"),
                (variables.qd, r"\dot{q}"),
                (variables.qdd, r"\ddot{q}"),
                (variables.tau, r"\tau"),
            ] {
                notation.set(dag, expr, with_subscript(base, &number.to_string()));
            }
            if let Node::Symbol(id) = dag.node(variables.q) {
                notation.joints.insert(id, number);
            }
        }
        for (number, contact) in robot.contacts.values().enumerate() {
            for coordinate in ["x", "y", "z"] {
                let name = force_name(&contact.name, coordinate);
                if let Some(id) = dag.find_symbol(&name) {
                    let subscript = format!("{coordinate},{}", number + 1);
                    notation.symbols.insert(id, with_subscript("f", &subscript));
                }
            }
        }
        for parameter in robot.parameters.values() {
            let (prefix, link) = match parameter.role {
                Role::Constant | Role::Unknown | Role::Effect(_) => continue,
                Role::Body(link, entry) => (entry.prefix(), link),
                Role::Joint(link, entry) => (entry.prefix(), link),
            };
            let name = &robot.links[link].name;
            // An entry may be an expression over the file's own symbols: those keep their names.
            if parameter.name != format!("{prefix}_{name}") {
                continue;
            }
            // The letter c is for cosines.
            let (base, words) = match prefix.strip_prefix('c') {
                Some(axis) => ("r".to_owned(), axis.to_owned()),
                None => base_and_words(prefix),
            };
            let number = numbers.get(&link).cloned().unwrap_or_else(|| word(name));
            let subscript = if words.is_empty() { number } else { format!("{words},{number}") };
            notation.set(dag, parameter.symbol, with_subscript(&base, &subscript));
        }
        notation.settled(dag)
    }

    /// After the names of a system of equations. There are no joints: angles of different letters
    /// may have one number.
    pub fn of_equations(dag: &Dag) -> Self {
        let mut notation = Self::of_names(dag);
        notation.joints.clear();
        notation.abbreviates = false;
        notation
    }

    /// Writes the parameters of a regressor's columns, `mx_LINK` or `fv_LINK`, with the number of
    /// the link's joint: `m_{x,1}`.
    pub(super) fn name_columns(&mut self, dag: &Dag, robot: &Robot, columns: &[ExprId]) {
        for &column in columns {
            let Node::Symbol(id) = dag.node(column) else { continue };
            let Some((prefix, link)) = dag.symbols()[id].name.split_once('_') else { continue };
            let Some(number) =
                robot.joints().position(|(joint, _)| robot.links[joint].name == link)
            else {
                continue;
            };
            let (base, words) = match prefix {
                "off" => (r"\mathrm{off}".to_owned(), String::new()),
                _ => base_and_words(prefix),
            };
            let comma = if words.is_empty() { "" } else { "," };
            let subscript = format!("{words}{comma}{}", number + 1);
            self.set(dag, column, with_subscript(&base, &subscript));
        }
    }

    /// Writes a symbol so.
    pub(super) fn set(&mut self, dag: &Dag, expr: ExprId, latex: String) {
        if let Node::Symbol(id) = dag.node(expr) {
            self.symbols.insert(id, latex);
        }
    }

    /// Decides what depends on all symbols together.
    fn settled(mut self, dag: &Dag) -> Self {
        let latex: Vec<&str> = dag.symbols().keys().map(|id| self.symbols[&id].as_str()).collect();
        // `c_1` and `c_{12}` are taken, `c_{x,1}` is not confused with them.
        let is_taken = |letter: char| {
            let subscripts =
                latex.iter().filter_map(|name| name.strip_prefix(letter)?.strip_prefix('_'));
            let mut numbers = subscripts.map(|text| text.trim_start_matches('{'));
            numbers.any(|text| text.starts_with(|first: char| first.is_ascii_digit()))
        };
        self.abbreviates = !['c', 's'].into_iter().any(is_taken);
        self.letter = ['x', 'y', 'z', 'w', 'u', 'v', 'h', 'e']
            .into_iter()
            .find(|&letter| !is_taken(letter))
            .unwrap_or('x');
        self
    }

    /// How a symbol is written.
    pub fn symbol(&self, dag: &Dag, id: SymbolId) -> String {
        match self.symbols.get(&id) {
            Some(latex) => latex.clone(),
            None => latex_of_name(&dag.symbols()[id].name, dag.symbols()[id].class),
        }
    }

    /// The name of the k-th intermediate.
    pub fn intermediate(&self, k: usize) -> String {
        with_subscript(&self.letter.to_string(), &k.to_string())
    }

    /// Whether sines and cosines of joint angles are written `s_1`, `c_{12}`.
    pub fn abbreviates(&self) -> bool {
        self.abbreviates
    }

    /// The numbers of the joints, in order, whose angles add up to an angle; none for an angle that
    /// is no such sum.
    pub(super) fn joints_of_angle(&self, dag: &Dag, angle: ExprId) -> Option<Vec<usize>> {
        let (mut numbers, mut pending) = (Vec::new(), vec![angle]);
        while let Some(expr) = pending.pop() {
            match dag.node(expr) {
                Node::Add(a, b) => pending.extend([a, b]),
                Node::Symbol(id) => numbers.push(*self.joints.get(&id)?),
                _ => return None,
            }
            // Longer sums are no abbreviations, and a shared one may be very long.
            if numbers.len() + pending.len() > self.joints.len() {
                return None;
            }
        }
        numbers.sort_unstable();
        let is_repeated = numbers.windows(2).any(|pair| pair[0] == pair[1]);
        (!is_repeated).then_some(numbers)
    }

    /// `letter_{12}` for joints 1 and 2; from ten joints on, the numbers are separated by commas.
    pub(super) fn abbreviation(&self, letter: &str, joints: &[usize]) -> String {
        let comma = if self.joints.values().any(|&number| number > 9) { "," } else { "" };
        let texts: Vec<String> = joints.iter().map(usize::to_string).collect();
        with_subscript(letter, &texts.join(comma))
    }
}

/// `base_{subscript}`, without braces around one character.
pub(super) fn with_subscript(base: &str, subscript: &str) -> String {
    match subscript.chars().count() {
        0 => base.to_owned(),
        1 => format!("{base}_{subscript}"),
        _ => format!("{base}_{{{subscript}}}"),
    }
}

/// How a name is written if nobody says: `q1` is `q_1`, `qd_knee` is `\dot{q}_\mathrm{knee}`,
/// `Ixx_2` is `I_{xx,2}`, `th1` is `\theta_1`.
pub fn latex_of_name(name: &str, class: SymbolClass) -> String {
    let (head, tail) = name.split_once('_').unwrap_or((name, ""));
    let letters = head.trim_end_matches(|c: char| c.is_ascii_digit());
    // A rate may carry its d behind the number, as in th1d.
    let (letters, digits, dots) = match dots_of(class) {
        0 => (letters, &head[letters.len()..], 0),
        dots => without_dots(head, dots),
    };
    let (base, words) = base_and_words(letters);
    let base = match dots {
        0 => base,
        1 => format!(r"\dot{{{base}}}"),
        _ => format!(r"\ddot{{{base}}}"),
    };
    let tail = word(tail);
    let parts = [words.as_str(), digits, tail.as_str()];
    let parts: Vec<&str> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    with_subscript(&base, &parts.join(","))
}

fn dots_of(class: SymbolClass) -> usize {
    match class {
        SymbolClass::Rate => 1,
        SymbolClass::Acceleration => 2,
        _ => 0,
    }
}

/// Letters and number of a name without the `d`s that say how often it is derived.
fn without_dots(head: &str, dots: usize) -> (&str, &str, usize) {
    let mark = &"dd"[..dots];
    let stem = head.strip_suffix(mark).unwrap_or(head);
    let letters = stem.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = &stem[letters.len()..];
    if stem.len() < head.len() && !letters.is_empty() {
        return (letters, digits, dots);
    }
    match letters.strip_suffix(mark) {
        Some(base) if !base.is_empty() => (base, digits, dots),
        _ => (letters, digits, 0),
    }
}

/// The base letter of a run of letters, and what of them is a subscript: `Ixx` is I and xx.
pub(super) fn base_and_words(letters: &str) -> (String, String) {
    if let Some((_, greek)) = GREEK.iter().find(|(name, _)| *name == letters) {
        return ((*greek).to_owned(), String::new());
    }
    // tauM is tau with the subscript M.
    let with_words = GREEK.iter().find_map(|(name, greek)| {
        let words = letters.strip_prefix(name)?;
        words.starts_with(|first: char| first.is_ascii_uppercase()).then_some((greek, words))
    });
    if let Some((greek, words)) = with_words {
        return ((*greek).to_owned(), words.to_owned());
    }
    match letters.len() {
        _ if letters == "off" => (r"\mathrm{off}".to_owned(), String::new()),
        0 => (r"\_".to_owned(), String::new()),
        1 => (letters.to_owned(), String::new()),
        2 | 3 => (letters[..1].to_owned(), letters[1..].to_owned()),
        _ => (format!(r"\mathrm{{{letters}}}"), String::new()),
    }
}

/// A subscript: numbers and single letters as they are, words upright.
pub(super) fn word(text: &str) -> String {
    let is_plain = text.len() < 2 || text.bytes().all(|byte| byte.is_ascii_digit());
    if is_plain { escape(text) } else { format!(r"\mathrm{{{}}}", escape(text)) }
}

/// Plain text for LaTeX: what has a meaning there is escaped, what its fonts lack is replaced, and
/// `^2` is raised.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => escaped.extend(['\\', character]),
            '~' => escaped.push_str(r"\textasciitilde{}"),
            // As in `kg m^2`.
            '^' => {
                let is_exponent = |c: &char| c.is_ascii_digit() || *c == '-';
                let mut exponent = String::new();
                while let Some(digit) = characters.next_if(is_exponent) {
                    exponent.push(digit);
                }
                match exponent.is_empty() {
                    true => escaped.push_str(r"\textasciicircum{}"),
                    false => escaped.push_str(&format!("$^{{{exponent}}}$")),
                }
            }
            '\\' => escaped.push_str(r"\textbackslash{}"),
            '<' => escaped.push_str(r"\textless{}"),
            '>' => escaped.push_str(r"\textgreater{}"),
            '"' => escaped.push_str("''"),
            '\n' | '\t' => escaped.push(' '),
            ' '..='~' | '\u{c0}'..='\u{17f}' => escaped.push(character),
            _ => escaped.push('?'),
        }
    }
    escaped
}
