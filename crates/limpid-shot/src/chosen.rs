//! The options that say which particles are meant, for programs that make no picture of them.

use crate::options::Options;
use clap::{ArgMatches, Args, Command, Error, FromArgMatches};

/// Options of which those alone can be given that say which files are read, how, and what of them is taken.
#[derive(Clone, Debug, Default)]
pub struct Chosen(pub Options);

/// Their names on the command line.
const NAMES: [&str; 11] =
    ["input", "start", "end", "step", "raw", "where", "clip", "drop_isolated", "attribute", "unit_scale", "radius"];

impl Args for Chosen {
    fn augment_args(command: Command) -> Command {
        let all = Options::augment_args(Command::new(""));
        command.args(all.get_arguments().filter(|argument| NAMES.contains(&argument.get_id().as_str())).cloned())
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Chosen {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        fn one<T: Clone + Send + Sync + 'static>(matches: &ArgMatches, name: &str) -> Option<T> {
            matches.get_one(name).cloned()
        }
        fn many(matches: &ArgMatches, name: &str) -> Option<Vec<String>> {
            matches.get_many(name).map(|values| values.cloned().collect())
        }
        Ok(Self(Options {
            input: many(matches, "input"),
            start: one(matches, "start"),
            end: one(matches, "end"),
            step: one(matches, "step"),
            raw: one(matches, "raw"),
            r#where: many(matches, "where"),
            clip: one(matches, "clip"),
            drop_isolated: one(matches, "drop_isolated"),
            attribute: many(matches, "attribute"),
            unit_scale: one(matches, "unit_scale"),
            radius: one(matches, "radius"),
            ..Options::default()
        }))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
