//! Takes that pages record.

use crate::harness::{Answer, Page, Stage, ask, metric, send};
use posewire::recording::Survey;
use posewire::sink::TakesSink;
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Session, Sink, Source};
use posewire_viewer::{Content, Feed, Options, Recorder, Server, ViewerSink};
use std::net::SocketAddr;
use std::path::Path;

/// Walkers that are shown and can be recorded.
struct Studio {
    server: Server,
    session: Session,
    stop: Stop,
}

impl Studio {
    fn open(folder: &Path) -> Self {
        let source = Source::open(&"synthetic:walk".parse().unwrap(), &PlaybackOptions::default()).unwrap();
        let endpoints = [source.endpoint().clone()];
        let feed = Feed::new(&endpoints);
        let takes = TakesSink::new(folder, &endpoints, None);
        let options = Options {
            listen: ([127, 0, 0, 1], 0).into(),
            recorder: Some(Recorder::new(takes.takes(), folder)),
            ..Options::default()
        };
        let server = Server::start(Content::Live(feed.clone()), &options).unwrap();
        let sinks: Vec<Box<dyn Sink>> = vec![Box::new(takes), Box::new(ViewerSink::new(&feed))];
        let stop = Stop::new();
        let session = Session::start([source], sinks, stop.clone());
        Self { server, session, stop }
    }

    fn close(self) {
        self.stop.stop();
        self.session.wait().unwrap();
    }
}

fn post(address: SocketAddr, path: &str, body: &str) -> Answer {
    let length = body.len();
    let head = format!("Host: {address}\r\nOrigin: http://{address}\r\nContent-Length: {length}\r\nConnection: close");
    send(address, &format!("POST {path} HTTP/1.1\r\n{head}\r\n\r\n{body}")).unwrap()
}

#[test]
fn a_take_is_begun_ended_listed_and_fetched() {
    let folder = tempfile::tempdir().unwrap();
    let studio = Studio::open(folder.path());
    let at = studio.server.address();
    let mut page = Page::open(at);
    assert_eq!(page.words("scene")["recorder"], true);
    assert_eq!(page.words("recorder")["state"], "idle");

    let begun = post(at, "/api/recorder/start", r#"{"name":"walk"}"#);
    assert_eq!((begun.status, &begun.json()["state"]), (200, &"recording".into()));
    let mut told = page.words("recorder");
    assert_eq!((&told["state"], &told["name"]), (&"recording".into(), &"walk".into()));
    while told["bytes"].as_u64() == Some(0) {
        told = page.words("recorder");
    }
    assert_eq!(post(at, "/api/recorder/start", r#"{"name":"run"}"#).status, 409);
    assert_eq!(post(at, "/api/recorder/stop", "").json()["state"], "idle");
    assert_eq!(post(at, "/api/recorder/stop", "").status, 409);

    let listed = ask(at, "/api/recordings").json();
    assert_eq!(listed[0]["name"], "walk.mcap");
    let fetched = ask(at, "/api/recordings/walk.mcap");
    let path = folder.path().join("walk.mcap");
    assert_eq!((fetched.status, &fetched.body), (200, &std::fs::read(&path).unwrap()));
    assert!(fetched.head.contains("filename=\"walk.mcap\""));
    assert!(Survey::of(&path).unwrap().complete);
    studio.close();
}

#[test]
fn no_name_leads_out_of_the_folder() {
    let above = tempfile::tempdir().unwrap();
    let folder = above.path().join("takes");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(above.path().join("secret.mcap"), "x").unwrap();
    std::fs::write(folder.join("notes.txt"), "x").unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink(above.path().join("secret.mcap"), folder.join("link.mcap")).unwrap();
    let studio = Studio::open(&folder);
    let at = studio.server.address();
    for name in ["../secret", "a/b", "..", "", "/etc/passwd", "a\\\\b", "a\\u0000"] {
        let answer = post(at, "/api/recorder/start", &format!("{{\"name\":\"{name}\"}}"));
        assert_eq!(answer.status, 400, "{name}");
        let text = answer.json()["error"].as_str().unwrap().to_owned();
        assert!(!text.contains(&*above.path().to_string_lossy()), "{text}");
    }
    for body in ["", "{}", "walk", r#"{"name":7}"#] {
        assert_eq!(post(at, "/api/recorder/start", body).status, 400, "{body}");
    }
    let long = format!("{{\"name\":\"{}\"}}", "a".repeat(70_000));
    assert_eq!(post(at, "/api/recorder/start", &long).status, 413);
    for name in [
        "../secret.mcap",
        "..%2Fsecret.mcap",
        "%2e%2e/secret.mcap",
        "notes.txt",
        "link.mcap",
        "no.mcap",
        ".",
    ] {
        assert_eq!(ask(at, &format!("/api/recordings/{name}")).status, 404, "{name}");
    }
    assert_eq!(ask(at, "/api/recordings").json(), serde_json::json!([]));
    assert!(metric(at, "posewire_viewer_refused_total{why=\"request\"}") >= 18);
    studio.close();
}

#[test]
fn without_a_folder_nothing_is_recorded() {
    let stage = Stage::new();
    let at = stage.address();
    assert_eq!(ask(at, "/api/recorder").json()["enabled"], false);
    for path in ["/api/recorder/start", "/api/recorder/stop"] {
        assert_eq!(post(at, path, r#"{"name":"walk"}"#).status, 404, "{path}");
    }
    assert_eq!(ask(at, "/api/recordings").status, 404);
    assert_eq!(stage.page().words("scene")["recorder"], false);
}
