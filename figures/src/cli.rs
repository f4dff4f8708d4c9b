//! The command line: arguments become a plain struct, then the work begins.
//!
//! stdout carries only what was asked for; progress, notes and errors go to stderr. Exit code 0: done, 1: could not,
//! 2: wrong usage.

use std::io::{self, BufRead, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::str::FromStr;

use clap::{CommandFactory, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

use crate::figure::{FIGURES, Figure};
use crate::generate::{ColoredBall, Rule};
use crate::import::foreign::Format;
use crate::options::{ChangeOptions, Depth, DrawOptions, PictureSize};
use crate::outcome::{Failure, exit_code, parsed, to_stdout};
use crate::output::{self, PictureFormat, Target};
use crate::text::meant;
use crate::{ask, convert, draw, generate, memory, stderr};

#[derive(Parser)]
#[command(
    name = "figures",
    version,
    about = "Draws the six figures of the report, and scenes, molecules and meshes of your own",
    after_help = "Examples:\n  \
                  figures all                                   the six figures, as PPM, into out/\n  \
                  figures render molecule.pdb -o molecule.png   `figures help render` has more\n\
                  Without an argument, asks for the number of the figure.\n\
                  Colors from 0 to 1 are stored as they are, those of a texture too: no gamma.",
    args_conflicts_with_subcommands = true
)]
struct Arguments {
    /// The figure to draw: a number from 1 to 6, or `all`
    figure: Option<Which>,
    #[command(flatten)]
    options: DrawOptions,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// List the six figures
    List,
    /// Draw scenes, molecules or meshes, each into a picture of its own: out/NAME.png
    #[command(after_help = "Examples:\n  \
            figures render molecule.pdb -o molecule.png\n  \
            figures render --view iso --background white part.stl\n  \
            figures render --frame 10 --radius-scale 0.3 run.xyz.gz -o run/\n  \
            figures render a.ply b.obj scene.toml -o pictures/\n  \
            zcat molecule.pdb.gz | figures render - -o - > molecule.png\n\
            Without a scene file objects lie on a stage: a camera that sees all of them, lights, a dark background.")]
    Render {
        /// Scenes in TOML; spheres in XYZ or PDB; meshes in OBJ, PLY or STL; any of them packed with gzip; `-` for stdin
        #[arg(required = true, value_name = "FILE|-")]
        files: Vec<PathBuf>,
        #[command(flatten)]
        changes: ChangeOptions,
        #[command(flatten)]
        options: DrawOptions,
    },
    /// Convert an image (PPM, PNG, JPEG, TIFF) to PPM or PNG
    Convert {
        /// The image to read
        input: PathBuf,
        /// The .ppm or .png to write, or `-` for stdout
        output: PathBuf,
        /// The format to write, if not by the ending of OUTPUT
        #[arg(long)]
        format: Option<PictureFormat>,
        /// Bits per sample, if not those of INPUT
        #[arg(long)]
        depth: Option<Depth>,
        /// Write no warnings
        #[arg(long)]
        quiet: bool,
    },
    /// Join the tiles of a picture
    Merge {
        /// The .ppm or .png to write, or `-` for stdout
        output: PathBuf,
        /// The tiles, in any order
        #[arg(required = true)]
        tiles: Vec<PathBuf>,
        /// The format to write, if not by the ending of OUTPUT
        #[arg(long)]
        format: Option<PictureFormat>,
    },
    /// Write a scene made by a rule
    Gen {
        #[command(subcommand)]
        piece: SetPiece,
        /// Where to: .xyz, .toml or .obj, or `-` for stdout
        #[arg(short, long, value_name = "FILE|-", default_value = "-", global = true)]
        out: PathBuf,
    },
    /// Ask a mesh: is a point inside, what does a ray hit, all of it, in order
    #[command(
        after_help = "Answers come one a line, in the order of the questions: `inside`, `on` or `outside`; or the \
                            hits of a ray, each an index and a t. With --json one object a line, with the crossings \
                            of closed surfaces too."
    )]
    #[command(group(clap::ArgGroup::new("question").required(true)))]
    Ask {
        /// A mesh in OBJ, PLY or STL, spheres in XYZ or PDB, or a scene in TOML
        mesh: PathBuf,
        /// Points, three numbers a line, or an XYZ file; `-` for stdin
        #[arg(long, value_name = "FILE|-", group = "question")]
        contains: Option<PathBuf>,
        /// Rays, six numbers a line: origin and direction; `-` for stdin
        #[arg(long, value_name = "FILE|-", group = "question")]
        rays: Option<PathBuf>,
        /// Answer in JSON lines
        #[arg(long)]
        json: bool,
        /// Write no warnings
        #[arg(long)]
        quiet: bool,
    },
    /// Count what a ray costs in a scene: by a loop, by the report's tree, and by the fast one
    Tests {
        /// A figure's number or a scene file
        scene: PathBuf,
        /// Columns and rows of the picture
        #[arg(long, value_name = "WxH", default_value = "1024x768")]
        size: PictureSize,
    },
    /// Write what makes a shell complete this program's arguments
    #[command(after_help = "For bash: figures completions bash > ~/.local/share/bash-completion/completions/figures")]
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Write the man page: `figures man | man -l -`
    Man,
    /// Moved: `cargo run --release -p report` measures speed against error
    #[command(hide = true)]
    Report {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
        rest: Vec<String>,
    },
}

/// A scene that is made by a rule.
#[derive(Subcommand)]
enum SetPiece {
    /// Spheres on spheres: (9^(depth + 1) - 1) / 8 of them, as XYZ or TOML
    Sphereflake {
        /// Generations after the first sphere
        #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(0..=7))]
        depth: u32,
    },
    /// Random spheres in a cube, as XYZ or TOML
    Spheres {
        /// The rule for places and sizes
        rule: Rule,
        /// How many
        #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
        count: u32,
    },
    /// A torus knot with colors at its vertices, as OBJ
    Knot {
        /// Rings along the tube, each with a tenth as many vertices
        #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(3..=20_000))]
        segments: u32,
    },
}

/// One figure or all of them.
#[derive(Clone, Copy)]
enum Which {
    One(&'static Figure),
    All,
}

impl FromStr for Which {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let figure = text.parse().ok().and_then(Figure::numbered);
        match (text, figure) {
            ("all", _) => Ok(Self::All),
            (_, Some(figure)) => Ok(Self::One(figure)),
            _ if is_file(text) => Err(format!("did you mean `figures render {}`?", quoted_for_shell(text))),
            _ if let Some(command) = meant_command(text) => Err(format!("did you mean `figures {command}`?")),
            _ => Err("expected the number of a figure, 1 to 6, or \"all\", or a command; see --help".to_owned()),
        }
    }
}

/// Whether a word is a file that can be drawn: there is one, or its ending says so.
fn is_file(text: &str) -> bool {
    let path = Path::new(text);
    path.is_file() || output::ending(path).is_some_and(|ending| Format::of_ending(&ending).is_some() || ending == "gz")
}

/// A word as a shell reads it, if it has a space.
fn quoted_for_shell(text: &str) -> String {
    if text.contains(' ') { format!("'{text}'") } else { text.to_owned() }
}

/// The command that was probably meant.
fn meant_command(text: &str) -> Option<String> {
    let commands = Arguments::command();
    let shown = commands.get_subcommands().filter(|command| !command.is_hide_set());
    let names: Vec<&str> = shown.map(clap::Command::get_name).collect();
    // A short word is near to many.
    let long = text.len() > 2;
    long.then(|| meant(text, names.into_iter()).map(str::to_owned)).flatten()
}

/// What is wrong with the first word if it stands in a command's place and is none. With more words behind it the parser
/// would speak of those.
fn slip() -> Option<String> {
    let mut words = std::env::args_os().skip(1);
    let (first, _) = (words.next()?, words.next()?);
    let first = first.to_str().filter(|word| !word.starts_with('-'))?;
    let mut commands = Arguments::command();
    commands.build();
    if commands.find_subcommand(first).is_some() {
        return None;
    }
    let problem = Which::from_str(first).err()?;
    Some(format!("error: invalid value '{first}' for '[FIGURE]': {problem}\n\nFor more information, try '--help'."))
}

/// Runs the program with the arguments it was started with.
pub fn main() -> ExitCode {
    if let Some(problem) = slip() {
        stderr::tell_lines(&problem);
        return ExitCode::from(2);
    }
    match parsed() {
        Ok(arguments) => exit_code(run(arguments)),
        Err(code) => code,
    }
}

fn run(arguments: Arguments) -> Result<(), Failure> {
    match arguments.command {
        None => {
            let which = arguments.figure.map_or_else(ask_for_figure, Ok)?;
            match which {
                Which::One(figure) => draw::figures(&[*figure], false, &arguments.options),
                Which::All => draw::figures(&FIGURES, true, &arguments.options),
            }
        }
        Some(Command::List) => {
            let lines = FIGURES.iter().map(|figure| format!("{}  {}\n", figure.number, figure.title));
            to_stdout(lines.collect::<String>().as_bytes())
        }
        Some(Command::Render { files, changes, options }) => draw::files(&files, &changes, &options),
        Some(Command::Convert { input, output, format, depth, quiet }) => {
            convert::convert(&input, &output, format, depth.map(Depth::maxval), quiet)
        }
        Some(Command::Merge { output, tiles, format }) => draw::merge(&output, &tiles, format),
        Some(Command::Gen { piece, out }) => piece.write(&out),
        Some(Command::Ask { mesh, contains, rays, json, quiet }) => {
            let style = ask::Style { json, quiet };
            match (contains, rays) {
                (Some(points), _) => ask::contains(&mesh, &points, style),
                (None, Some(rays)) => ask::rays(&mesh, &rays, style),
                (None, None) => Err(Failure::Usage("ask with --contains or --rays".to_owned())),
            }
        }
        Some(Command::Tests { scene, size }) => draw::count_tests(&scene, size),
        Some(Command::Completions { shell }) => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Arguments::command(), "figures", &mut script);
            to_stdout(&script)
        }
        Some(Command::Man) => {
            let mut page = Vec::new();
            clap_mangen::Man::new(Arguments::command()).render(&mut page)?;
            to_stdout(&page)
        }
        Some(Command::Report { rest }) => Err(Failure::Usage(format!(
            "the report is a program of its own: `cargo run --release -p report{}`",
            if rest.is_empty() { String::new() } else { format!(" -- {}", rest.join(" ")) }
        ))),
    }
}

impl SetPiece {
    fn write(&self, out: &Path) -> Result<(), Failure> {
        let ending = output::ending(out).unwrap_or_default();
        let (comment, balls) = match *self {
            Self::Knot { segments } => {
                if !matches!(ending.as_str(), "" | "obj") {
                    return Err(Failure::Usage(format!("a knot is a mesh: expected a file.obj, found .{ending}")));
                }
                return Target::exactly(out).write_with(|out| generate::write_knot(segments, out));
            }
            Self::Sphereflake { depth } => {
                let (bytes, what) = (generate::sphereflake_memory(depth), format!("depth {depth}"));
                memory::check(bytes, &what, "make fewer generations (--depth)")?;
                (format!("sphereflake of depth {depth}"), generate::sphereflake(depth))
            }
            Self::Spheres { rule, count } => {
                let bytes = u64::from(count) * size_of::<ColoredBall>() as u64;
                memory::check(bytes, &format!("{count} spheres"), "make fewer of them (--count)")?;
                let name = rule.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default();
                (format!("{count} spheres, {name}"), generate::random(rule, count))
            }
        };
        let write = match ending.as_str() {
            "" | "xyz" => generate::write_xyz,
            "toml" => generate::write_toml,
            _ => return Err(Failure::Usage(format!("expected a file.xyz or a file.toml, found .{ending}"))),
        };
        Target::exactly(out).write_with(|out| write(&balls, &comment, out))
    }
}

/// Asks for the number of the figure, as the original program did.
fn ask_for_figure() -> Result<Which, Failure> {
    let stdin = io::stdin();
    if stdin.is_terminal() {
        let _ = write!(io::stderr(), "Which figure, 1 to 6? ");
    }
    let mut answer = String::new();
    // No answer is longer than this; an endless one is not read to its end.
    let read = stdin.lock().take(64).read_line(&mut answer);
    let answer = answer.trim();
    match answer.parse() {
        Ok(which) if read.is_ok() => Ok(which),
        _ => Err(Failure::Usage(format!("expected the number of a figure, 1 to 6, or \"all\", found {answer:?}"))),
    }
}
