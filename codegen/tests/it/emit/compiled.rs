//! Emitted C and C++ as programs: they read states and write what each function makes of them.

use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::emit::c;
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::Robot;
use denavit_codegen::program::{
    Evaluator, Instruction, Operation, Program, Routine, UnaryOperation, fuse, lower,
    parameter_defaults, prelude_values,
};
use denavit_runtime::Transcendental;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Values of the parameters of a model that gives none.
const MADE_UP: f64 = 0.75;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Language {
    C,
    Cpp,
}

/// The compilers of a language that are installed; one must be.
pub(super) fn compilers(language: Language) -> Vec<&'static str> {
    let wanted = match language {
        Language::C => ["gcc", "clang"],
        Language::Cpp => ["g++", "clang++"],
    };
    let is_there = |compiler: &&&str| {
        let found = Command::new(compiler).arg("--version").stdout(Stdio::null()).status().is_ok();
        if !found {
            println!("{compiler} is not installed: nothing is compiled with it");
        }
        found
    };
    let found: Vec<&str> = wanted.iter().filter(is_there).copied().collect();
    assert!(found.first() == Some(&wanted[0]), "{} is needed", wanted[0]);
    found
}

/// How a model is compiled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Build {
    pub(super) language: Language,
    pub(super) compiler: &'static str,
    pub(super) optimisation: &'static str,
    pub(super) real: &'static str,
    pub(super) defines: &'static [&'static str],
}

impl Default for Build {
    fn default() -> Self {
        Self {
            language: Language::C,
            compiler: "gcc",
            optimisation: "-O0",
            real: "double",
            defines: &[],
        }
    }
}

/// A scalar of C.
pub(super) trait Real: Transcendental {
    const BYTES: usize;
    fn to_bytes(self) -> Vec<u8>;
    fn of_bytes(bytes: &[u8]) -> Self;
    fn bits(self) -> u64;
}

impl Real for f64 {
    const BYTES: usize = 8;

    fn to_bytes(self) -> Vec<u8> {
        self.to_ne_bytes().to_vec()
    }

    fn of_bytes(bytes: &[u8]) -> Self {
        Self::from_ne_bytes(bytes.try_into().unwrap())
    }

    fn bits(self) -> u64 {
        self.to_bits()
    }
}

impl Real for f32 {
    const BYTES: usize = 4;

    fn to_bytes(self) -> Vec<u8> {
        self.to_ne_bytes().to_vec()
    }

    fn of_bytes(bytes: &[u8]) -> Self {
        Self::from_ne_bytes(bytes.try_into().unwrap())
    }

    fn bits(self) -> u64 {
        u64::from(self.to_bits())
    }
}

/// A model lowered here and now, and what it computes.
pub(super) struct Reference {
    robot: Robot,
    program: Program,
    parameters: Vec<f64>,
    /// Names and lengths of all arguments of all functions.
    arguments: Vec<(&'static str, usize)>,
}

impl Reference {
    pub(super) fn new(
        robot: &Robot,
        flavour: Flavour,
        wanted: &[FunctionName],
        is_fused: bool,
    ) -> Self {
        let derivation = derive(robot, flavour, wanted).unwrap();
        let mut program = lower(&derivation.dag, &derivation.functions).unwrap();
        if is_fused {
            fuse(&mut program);
        }
        let defaults = parameter_defaults(&program, &derivation.robot);
        let given = derivation.robot.parameters.values().all(|one| one.default.is_some());
        let value = |default: &Option<f64>| default.filter(|_| given).unwrap_or(MADE_UP);
        let parameters = defaults.iter().map(value).collect();
        let mut arguments = Vec::new();
        for shape in program.routines.iter().flat_map(|routine| &routine.arguments) {
            if !arguments.contains(&(shape.name, shape.len)) {
                arguments.push((shape.name, shape.len));
            }
        }
        Self { robot: derivation.robot, program, parameters, arguments }
    }

    /// Values of all arguments, one sample after the other; the last one has angles that are
    /// anything but ordinary.
    pub(super) fn samples(&self, count: usize) -> Vec<Vec<f64>> {
        let length: usize = self.arguments.iter().map(|(_, length)| length).sum();
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0) * 2.0
        };
        let mut samples: Vec<Vec<f64>> =
            (0..count).map(|_| (0..length).map(|_| next()).collect()).collect();
        if let Some(last) = samples.last_mut() {
            last.iter_mut().for_each(|value| *value *= 3e5);
        }
        samples
    }

    /// What each routine makes of each sample.
    fn evaluate<S: Real>(&self, samples: &[Vec<f64>]) -> Vec<Vec<Vec<S>>> {
        let prelude = prelude_values(&self.program, &self.parameters).unwrap();
        let of_routine = |routine: &Routine, sample: &[f64]| {
            let mut evaluator = Evaluator::<S>::new(routine, &prelude);
            let mut outputs = vec![S::ZERO; evaluator.outputs()];
            let arguments: Vec<Vec<S>> = routine
                .arguments
                .iter()
                .map(|shape| {
                    let place = self.place(shape.name, shape.len);
                    sample[place..place + shape.len].iter().map(|&v| S::from_f64(v)).collect()
                })
                .collect();
            let arguments: Vec<&[S]> = arguments.iter().map(Vec::as_slice).collect();
            evaluator.evaluate(&arguments, &mut outputs).unwrap();
            outputs
        };
        let of_sample = |sample: &Vec<f64>| {
            self.program.routines.iter().map(|routine| of_routine(routine, sample)).collect()
        };
        samples.iter().map(of_sample).collect()
    }

    fn place(&self, name: &str, length: usize) -> usize {
        let before = self.arguments.iter().take_while(|known| **known != (name, length));
        before.map(|(_, length)| length).sum()
    }

    /// Every entry has the bits of the interpreter; where the platform's functions come in, its
    /// value but for rounding.
    pub(super) fn assert_bits<S: Real + Into<f64>>(
        &self,
        found: &[S],
        samples: &[Vec<f64>],
        build: &Build,
    ) {
        let expected = self.evaluate::<S>(samples);
        let mut rest = found;
        for (sample, values) in expected.iter().enumerate() {
            for (routine, values) in self.program.routines.iter().zip(values) {
                let (own, others) = rest.split_at(values.len());
                rest = others;
                if is_of_the_platform(&self.program, routine) {
                    let (own, values) = (doubles(own), doubles(values));
                    assert_all_near(&routine.full_name(), &own, &values, 1e-5);
                    continue;
                }
                for (entry, (own, value)) in own.iter().zip(values).enumerate() {
                    // A sign or payload of NaN is no promise.
                    let is_nan = |value: S| Into::<f64>::into(value).is_nan();
                    assert!(
                        own.bits() == value.bits() || (is_nan(*own) && is_nan(*value)),
                        "{} of {}, {build:?}: entry {entry} of sample {sample} is {own:?}, \
                         not {value:?}",
                        routine.full_name(),
                        self.robot.name
                    );
                }
            }
        }
        assert!(rest.is_empty(), "{} numbers too many", rest.len());
    }

    /// Every entry is near the interpreter's in `f64`, in parts of the largest one.
    pub(super) fn assert_near(&self, found: &[f64], samples: &[Vec<f64>], tolerance: f64) {
        let expected = self.evaluate::<f64>(samples);
        let mut rest = found;
        // The last sample is anything but ordinary: rounding to `float` moves its angles.
        for values in &expected[..expected.len() - 1] {
            for (routine, values) in self.program.routines.iter().zip(values) {
                let (own, others) = rest.split_at(values.len());
                rest = others;
                assert_all_near(&routine.full_name(), own, values, tolerance);
            }
        }
    }
}

fn doubles<S: Copy + Into<f64>>(values: &[S]) -> Vec<f64> {
    values.iter().map(|&value| value.into()).collect()
}

fn assert_all_near(name: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    let largest = expected.iter().fold(1.0_f64, |largest, value| largest.max(value.abs()));
    for (own, value) in found.iter().zip(expected) {
        let is_near = (own - value).abs() <= tolerance * largest;
        assert!(is_near || (own.is_nan() && value.is_nan()), "{name}: {own} is not {value}");
    }
}

/// Whether a function calls more of the platform than its exact square root.
fn is_of_the_platform(program: &Program, routine: &Routine) -> bool {
    let is_sqrt = |step: &Instruction| {
        matches!(
            step,
            Instruction::Value { operation: Operation::Unary(UnaryOperation::Sqrt, _), .. }
        )
    };
    let steps = program.prelude.instructions.iter().chain(&routine.code.instructions);
    steps.into_iter().any(|step| step.is_transcendental() && !is_sqrt(step))
}

/// A program of a model.
pub(super) struct Compiled {
    program: PathBuf,
}

impl Compiled {
    pub(super) fn new(reference: &Reference, build: &Build) -> Self {
        static NUMBER: AtomicUsize = AtomicUsize::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("c_{number}"));
        std::fs::create_dir_all(&folder).unwrap();
        let main = match build.language {
            Language::C => {
                let files = c::files(&reference.robot, &reference.program, "model.h").unwrap();
                assert_narrow(&files.header);
                assert_narrow(&files.source);
                std::fs::write(folder.join("model.h"), &files.header).unwrap();
                std::fs::write(folder.join("model.c"), &files.source).unwrap();
                let prefix = prefix(&files.header, "typedef ", "_real;");
                (driver(reference, build, &files.header, &prefix), "main.c", prefix)
            }
            Language::Cpp => {
                let header = c::cpp_header(&reference.robot, &reference.program).unwrap();
                assert_narrow(&header);
                std::fs::write(folder.join("model.hpp"), &header).unwrap();
                let prefix = prefix(&header, "} // namespace ", "");
                (driver(reference, build, &header, &prefix), "main.cpp", prefix)
            }
        };
        std::fs::write(folder.join(main.1), &main.0).unwrap();
        compile(&folder, build, &main.2);
        Self { program: folder.join("program") }
    }

    /// Runs the program on samples; the results of all functions, one after the other.
    pub(super) fn run<S: Real>(&self, samples: &[Vec<f64>]) -> Vec<S> {
        let mut child = Command::new(&self.program)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let bytes: Vec<u8> =
            samples.iter().flatten().flat_map(|&value| S::from_f64(value).to_bytes()).collect();
        let mut stdin = child.stdin.take().unwrap();
        let writer = std::thread::spawn(move || stdin.write_all(&bytes).unwrap());
        let output = child.wait_with_output().unwrap();
        writer.join().unwrap();
        assert!(output.status.success());
        output.stdout.chunks_exact(S::BYTES).map(S::of_bytes).collect()
    }
}

fn assert_narrow(text: &str) {
    // The table of operations is as wide as its columns.
    for line in text.lines().filter(|line| !line.starts_with("//     ")) {
        assert!(line.chars().count() <= 100, "{line}");
    }
}

/// What stands last between two words of a line.
fn prefix(text: &str, before: &str, after: &str) -> String {
    let line = text.lines().rev().find(|line| line.starts_with(before) && line.ends_with(after));
    let rest = line.unwrap().strip_suffix(after).unwrap();
    rest.rsplit(' ').next().unwrap().to_owned()
}

fn compile(folder: &Path, build: &Build, prefix: &str) {
    let real_flag =
        (build.real == "float").then(|| format!("-D{}_REAL=float", prefix.to_ascii_uppercase()));
    let files: &[&str] = match build.language {
        Language::C => &["-std=c99", "model.c", "main.c"],
        Language::Cpp => &["-std=c++17", "main.cpp"],
    };
    let mut compile = Command::new(build.compiler);
    compile
        .args([build.optimisation, "-o", "program"])
        .args(build.defines)
        .args(real_flag)
        .args(files)
        .arg("-lm")
        .current_dir(folder);
    warning_free(&mut compile);
}

/// Compiles without a warning.
pub(super) fn warning_free(compile: &mut Command) {
    let output = compile.args(["-Wall", "-Wextra", "-pedantic", "-Werror"]).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    let shown: String = errors.lines().take(20).fold(String::new(), |all, line| all + line + "\n");
    assert!(output.status.success(), "{compile:?}: {shown}");
}

/// A program that reads samples and writes the results of all functions.
fn driver(reference: &Reference, build: &Build, header: &str, prefix: &str) -> String {
    let is_cpp = build.language == Language::Cpp;
    let mut text = String::from("#include <stdio.h>\n#include <string.h>\n");
    text += if is_cpp { "#include \"model.hpp\"\n" } else { "#include \"model.h\"\n" };
    writeln!(text, "typedef {} number;", build.real).unwrap();
    text += "int main(void) {\n";
    for (name, length) in &reference.arguments {
        writeln!(text, "    number {name}[{length}];").unwrap();
    }
    let has_parameters = !reference.program.parameters.is_empty();
    if has_parameters {
        text += &parameters(reference, header, prefix, is_cpp);
    }
    text += "    for (;;) {\n";
    for (name, length) in &reference.arguments {
        let read = format!("fread({name}, sizeof(number), {length}, stdin)");
        writeln!(text, "        if ({read} != {length}) return 0;").unwrap();
    }
    let mut seen: Vec<(FunctionName, usize)> = Vec::new();
    for routine in &reference.program.routines {
        let place = seen.iter().filter(|(name, _)| *name == routine.name).count();
        seen.push((routine.name, place));
        text += &call(routine, place, prefix, is_cpp, has_parameters);
    }
    text + "    }\n}\n"
}

/// A call of a routine, the `place`th of its name.
fn call(
    routine: &Routine,
    place: usize,
    prefix: &str,
    is_cpp: bool,
    has_parameters: bool,
) -> String {
    let mut text = String::from("        {\n");
    let mut passed: Vec<String> = Vec::new();
    if has_parameters {
        passed.push(if is_cpp { "parameters" } else { "&parameters" }.to_owned());
    }
    if routine.link.is_some() {
        let is_foot = routine.name == FunctionName::FootRotationIndicator;
        passed.push(match (is_cpp, is_foot) {
            (true, true) => format!("{prefix}::Foot({place})"),
            (true, false) => format!("{prefix}::Link({place})"),
            (false, true) => format!("({prefix}_foot){place}"),
            (false, false) => format!("({prefix}_link){place}"),
        });
    }
    passed.extend(routine.arguments.iter().map(|shape| match shape.name {
        "t" => "t[0]".to_owned(),
        name => name.to_owned(),
    }));
    for (row, output) in routine.outputs.iter().enumerate() {
        writeln!(text, "            static number out{row}[{}];", output.len().max(1)).unwrap();
        passed.push(format!("out{row}"));
    }
    let separator = if is_cpp { "::" } else { "_" };
    let passed = passed.join(", ");
    writeln!(text, "            {prefix}{separator}{}({passed});", routine.name).unwrap();
    for (row, output) in routine.outputs.iter().enumerate() {
        let length = output.len();
        let write = format!("fwrite(out{row}, sizeof(number), {length}, stdout)");
        writeln!(text, "            if ({write} != {length}) return 1;").unwrap();
    }
    text + "        }\n"
}

/// The model's own parameters, or made up ones where it has none.
fn parameters(reference: &Reference, header: &str, prefix: &str, is_cpp: bool) -> String {
    let has_defaults = header.contains("default_parameters(");
    let count = reference.robot.parameters.len();
    let made_up = format!("{{{}}}", vec![MADE_UP.to_string(); count].join(", "));
    match (is_cpp, has_defaults) {
        (true, true) => {
            format!("    const auto parameters = {prefix}::default_parameters<number>();\n")
        }
        (true, false) => format!(
            "    const {prefix}::ModelParameters<double> model = {made_up};\n    const auto \
             parameters = {prefix}::convert<number>({prefix}::prepare(model));\n"
        ),
        (false, true) => format!(
            "    {prefix}_parameters parameters;\n    \
             {prefix}_default_parameters(&parameters);\n"
        ),
        (false, false) => format!(
            "    const {prefix}_model_parameters model = {made_up};\n    {prefix}_parameters \
             parameters;\n    {prefix}_prepare(&parameters, &model);\n"
        ),
    }
}
