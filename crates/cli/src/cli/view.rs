//! The arguments of `posewire view`.

use clap::Args;
use std::net::SocketAddr;

/// Show live streams or takes in a browser.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire view                                  whatever arrives on UDP port 9763
  posewire view mxtp://0.0.0.0 natnet://10.0.0.7 several systems on one stage
  posewire view take.mvnx other.mvnx             takes and recordings, to play, scrub and compare
  posewire view \"synthetic:walk?people=4\"
  posewire view mxtp://0.0.0.0 --listen 0.0.0.0:9780   for tablets in the room; the address has a token

Live streams are shown as they come; takes are loaded whole, and each page plays them for itself.")]
pub(crate) struct View {
    /// Where to listen, which NatNet server to connect to, synthetic:walk; or takes, recordings and captures.
    #[arg(value_name = "SOURCE", default_value = "mxtp://0.0.0.0:9763")]
    pub(crate) sources: Vec<String>,

    #[command(flatten)]
    pub(crate) page: Page,
}

/// How the page is served.
#[derive(Debug, Args)]
pub(crate) struct Page {
    /// Where to serve the page. Any address but 127.0.0.1 lets other machines see it, with a token.
    #[arg(long, value_name = "ADDR:PORT", default_value = "127.0.0.1:9780")]
    pub(crate) listen: SocketAddr,

    /// Open the page in this machine's browser.
    #[arg(long)]
    pub(crate) open: bool,
}
