//! The chain of transformations on the command line: its links apply in the order in which they stand.

use std::path::PathBuf;

use clap::{ArgAction, ArgMatches, Args, Command, FromArgMatches};
use glam::DVec3;

/// A link as it was asked for.
#[derive(Clone, Debug)]
pub enum Link {
    /// A file of links.
    Chain(PathBuf),
    /// Center and ratio.
    Inversion(DVec3, f64),
    /// A file of factors.
    Combescure(PathBuf),
    Translate(DVec3),
    Scale(f64),
    /// Axis and degrees.
    Rotate(DVec3, f64),
}

/// Links in the order in which they stand on the command line, which a derived parser would not keep.
#[derive(Clone, Debug)]
pub struct ChainArgs {
    pub links: Vec<Link>,
}

impl Args for ChainArgs {
    fn augment_args(command: Command) -> Command {
        let option = |name: &'static str, value: &'static str, help: &'static str| {
            clap::Arg::new(name)
                .long(name)
                .value_name(value)
                .action(ArgAction::Append)
                .allow_hyphen_values(true)
                .help_heading("Chain")
                .help(help)
        };
        command
            .arg(
                option("chain", "FILE", "Links from a file (JSON)")
                    .value_parser(|text: &str| Ok::<_, String>(Link::Chain(PathBuf::from(text)))),
            )
            .arg(
                option("inversion", "X,Y,Z,K", "Inversion with this center and ratio")
                    .value_parser(|text: &str| parse_four(text).map(|(center, ratio)| Link::Inversion(center, ratio))),
            )
            .arg(
                option("combescure", "FILE", "Combescure transformation with factors from a file (JSON)")
                    .value_parser(|text: &str| Ok::<_, String>(Link::Combescure(PathBuf::from(text)))),
            )
            .arg(
                option("translate", "X,Y,Z", "Move by a vector")
                    .value_parser(|text: &str| parse_vector(text).map(Link::Translate)),
            )
            .arg(
                option("scale", "S", "Scale about the origin")
                    .value_parser(|text: &str| parse_finite(text).map(Link::Scale)),
            )
            .arg(
                option("rotate", "X,Y,Z,DEGREES", "Turn about an axis through the origin")
                    .value_parser(|text: &str| parse_four(text).map(|(axis, degrees)| Link::Rotate(axis, degrees))),
            )
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for ChainArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut links: Vec<(usize, Link)> = Vec::new();
        for name in ["chain", "inversion", "combescure", "translate", "scale", "rotate"] {
            let (Some(places), Some(values)) = (matches.indices_of(name), matches.get_many::<Link>(name)) else {
                continue;
            };
            links.extend(places.zip(values.cloned()));
        }
        links.sort_by_key(|(place, _)| *place);
        Ok(Self { links: links.into_iter().map(|(_, link)| link).collect() })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

fn parse_finite(text: &str) -> Result<f64, String> {
    let value = text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
    value.ok_or_else(|| format!("expected a finite number, found \"{text}\""))
}

/// Reads "1,2.5,-3".
pub fn parse_list(text: &str) -> Result<Vec<f64>, String> {
    text.split(',').map(parse_finite).collect()
}

/// Reads "x,y" or "x,y,z".
pub fn parse_vector(text: &str) -> Result<DVec3, String> {
    match parse_list(text)?[..] {
        [x, y] => Ok(DVec3::new(x, y, 0.0)),
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        ref values => Err(format!("expected x,y or x,y,z, found {} numbers", values.len())),
    }
}

/// Reads "x,y,z,w".
pub fn parse_four(text: &str) -> Result<(DVec3, f64), String> {
    match parse_list(text)?[..] {
        [x, y, z, w] => Ok((DVec3::new(x, y, z), w)),
        ref values => Err(format!("expected 4 numbers, found {}", values.len())),
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::super::canal::{CanalArgs, CanalCommand};
    use super::super::{Cli, Command as Asked};

    #[test]
    fn links_keep_their_order() {
        let line = "shapeop canal transform a.json --scale 2 --inversion -1,0,2,-0.5 --translate 1,2 --scale -3 --chain c.json";
        let Asked::Canal(CanalArgs { command: CanalCommand::Transform(args) }) =
            Cli::try_parse_from(line.split(' ')).unwrap().command
        else {
            panic!("another command");
        };
        let names: Vec<String> = args.chain.links.iter().map(|link| format!("{link:?}")).collect();
        assert_eq!(names[0], "Scale(2.0)");
        assert!(names[1].starts_with("Inversion(") && names[1].ends_with("-0.5)"));
        assert_eq!(names[3..], ["Scale(-3.0)", "Chain(\"c.json\")"]);
        let wrong = line.replace("-1,0,2,-0.5", "1,2,3");
        assert!(Cli::try_parse_from(wrong.split(' ')).unwrap_err().to_string().contains("expected 4 numbers, found 3"));
    }
}
