//! The arguments of `posewire view`, and of the page beside other verbs.

use clap::Args;
use std::net::SocketAddr;
use std::path::PathBuf;

/// Show live streams or takes in a browser.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire view                                   whatever arrives on UDP port 9763
  posewire view mxtp://0.0.0.0 natnet://10.0.0.7  several systems on one stage
  posewire view take.mvnx other.mcap              takes and recordings, to play, scrub and compare
  posewire view \"synthetic:walk?people=4\" --open
  posewire view mxtp://0.0.0.0 --listen 0.0.0.0:9780   for tablets in the room too
  posewire view mxtp://0.0.0.0 --record-dir takes      with a button to record

The page is in this program, and is served to this machine alone unless --listen says otherwise; other
machines then need the token in the address that is printed. Takes are loaded whole, and each page plays
them for itself. monitor, stream, record, replay and demo have --view to show what they do.")]
pub(crate) struct View {
    /// Live: where to listen, which NatNet server to connect to, synthetic:walk. Or files: takes, recordings, captures.
    #[arg(value_name = "SOURCE", default_value = "mxtp://0.0.0.0:9763")]
    pub(crate) sources: Vec<String>,

    /// Where to serve the page; 0.0.0.0:9780 lets every machine of the network see it that has the token.
    #[arg(long, value_name = "ADDR:PORT", default_value = ADDRESS)]
    pub(crate) listen: SocketAddr,

    /// Let pages record what is live: begin, end, name, list and fetch takes in this folder.
    #[arg(long, value_name = "DIR")]
    pub(crate) record_dir: Option<PathBuf>,

    /// Ask pages of this machine for the token too, as where several people share it.
    #[arg(long)]
    pub(crate) token: bool,

    /// Open the page in this machine's browser.
    #[arg(long)]
    pub(crate) open: bool,
}

/// The page beside what a verb does.
#[derive(Debug, Args)]
pub(crate) struct Beside {
    /// Show it in a browser too; served to this machine alone, at 127.0.0.1:9780, unless another address is given.
    #[arg(long, value_name = "ADDR:PORT", num_args = 0..=1, require_equals = true, default_missing_value = ADDRESS)]
    pub(crate) view: Option<SocketAddr>,
}

const ADDRESS: &str = "127.0.0.1:9780";
