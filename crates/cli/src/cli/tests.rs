//! Every example in help and documents is a command that there is.

use super::*;
use clap::CommandFactory;

/// The words of a line as a shell gives them: quotes keep words together, `#`, `>` and `|` end the command.
fn words(line: &str) -> Vec<String> {
    let end = line.find(['#', '>', '|']).unwrap_or(line.len());
    let pieces = line[..end].split('"').enumerate();
    let words = pieces.flat_map(|(place, piece)| match place % 2 {
        0 => piece.split_whitespace().map(str::to_owned).collect(),
        _ => vec![piece.to_owned()],
    });
    words.collect()
}

fn assert_parses(line: &str) {
    let words = words(line);
    let is_endpoint = |word: &&String| word.contains("://") || word.starts_with("synthetic:");
    for word in words.iter().filter(is_endpoint) {
        let endpoint = word.parse::<posewire::endpoint::Endpoint>();
        assert!(endpoint.is_ok(), "{line}: {}", endpoint.unwrap_err());
    }
    let parsed = Cli::try_parse_from(words);
    assert!(parsed.is_ok(), "{line}: {}", parsed.unwrap_err());
}

/// The lines of shell code that call the program, and such code within other lines. Two words only name a verb.
fn commands(page: &str) -> Vec<&str> {
    let mut commands = Vec::new();
    let mut in_shell = false;
    for line in page.lines() {
        match line.strip_prefix("```") {
            Some(language) => in_shell = language == "sh",
            None if in_shell => commands.push(line),
            None => {
                let pieces = line.split('`').skip(1).step_by(2);
                commands.extend(pieces.filter(|piece| piece.split_whitespace().count() > 2));
            }
        }
    }
    commands.retain(|command| command.starts_with("posewire "));
    commands
}

#[test]
fn every_command_of_the_documents_is_one() {
    for (page, text, at_least) in [
        ("README", include_str!("../../../../README.md"), 10),
        ("faults", include_str!("../../../../docs/faults.md"), 3),
        ("natnet", include_str!("../../../../docs/natnet.md"), 14),
        ("replaying", include_str!("../../../../docs/replaying.md"), 6),
        ("viewer", include_str!("../../../../docs/viewer.md"), 0),
        (
            "troubleshooting",
            include_str!("../../../../docs/troubleshooting.md"),
            2,
        ),
    ] {
        let commands = commands(text);
        for command in &commands {
            assert_parses(command);
        }
        assert!(commands.len() >= at_least, "only {commands:?} were found in {page}");
    }
}

#[test]
fn every_example_of_the_help_is_one() {
    let mut count = 0;
    for verb in Cli::command().get_subcommands() {
        let examples = verb.get_after_help().map(ToString::to_string).unwrap_or_default();
        for line in examples.lines() {
            if let Some(place) = line.find("posewire ").filter(|_| line.starts_with("  ")) {
                let (command, _) = line[place..].split_once("   ").unwrap_or((&line[place..], ""));
                assert_parses(command);
                count += 1;
            }
        }
    }
    assert!(count >= 10, "only {count} were found");
}
