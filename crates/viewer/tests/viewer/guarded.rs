//! Who is refused, and that it is counted.

use crate::harness::{Page, Stage, ask, metric, send};
use posewire_viewer::Options;
use std::net::SocketAddr;
use tungstenite::Message;
use tungstenite::protocol::frame::coding::CloseCode;

/// A request with these lines in its head.
fn status(address: SocketAddr, line: &str, head: &[String]) -> u16 {
    let request = format!("{line} HTTP/1.1\r\n{}\r\nConnection: close\r\n\r\n", head.join("\r\n"));
    send(address, &request).unwrap().status
}

fn host(value: impl std::fmt::Display) -> String {
    format!("Host: {value}")
}

fn origin(value: impl std::fmt::Display) -> String {
    format!("Origin: http://{value}")
}

#[test]
fn only_this_host_and_its_own_page_are_answered() {
    let stage = Stage::new();
    let at = stage.address();
    let port = at.port();
    let (ours, evil) = (host(at), format!("evil.example:{port}"));
    for path in ["/", "/healthz", "/metrics", "/api/scene", "/ws", "/nothing"] {
        let line = format!("GET {path}");
        assert_eq!(status(at, &line, &[host(&evil)]), 421, "{path}");
        assert_eq!(status(at, &line, &[ours.clone(), origin(&evil)]), 403, "{path}");
    }
    assert_eq!(stage.metric("posewire_viewer_refused_total{why=\"host\"}"), 6);
    assert_eq!(stage.metric("posewire_viewer_refused_total{why=\"origin\"}"), 6);

    assert_eq!(status(at, "GET /healthz", &[host(format!("localhost:{port}"))]), 200);
    assert_eq!(status(at, "GET /healthz", &[ours.clone(), origin(at)]), 200);
    assert_eq!(
        status(at, "POST /api/scene", std::slice::from_ref(&ours)),
        403,
        "what changes says where it is from"
    );
    assert_eq!(status(at, "GET /ws", std::slice::from_ref(&ours)), 403);
    assert_eq!(status(at, "GET /ws", &[ours.clone(), origin(at)]), 400, "no WebSocket");
    assert_eq!(status(at, "GET /healthz", &[ours.clone(), ours.clone()]), 421);
    assert_eq!(
        status(at, &format!("GET http://{at}/healthz"), std::slice::from_ref(&ours)),
        200
    );
    assert_eq!(status(at, &format!("GET http://{evil}/healthz"), &[ours]), 421);
}

#[test]
fn what_is_not_there_is_refused_with_help() {
    let stage = Stage::new();
    for path in [
        "/nothing",
        "/../Cargo.toml",
        "/assets/../../Cargo.toml",
        "/%2e%2e/Cargo.toml",
        "/api/takes/0/frames",
    ] {
        let answer = ask(stage.address(), path);
        assert!(matches!(answer.status, 400 | 404), "{path}");
        let body = answer.json();
        assert!(body["error"].is_string() && body["help"].is_string(), "{path}");
    }
    assert_eq!(stage.metric("posewire_viewer_refused_total{why=\"request\"}"), 5);
}

#[test]
fn every_answer_keeps_others_away() {
    let stage = Stage::new();
    for path in ["/", "/healthz", "/api/scene", "/nothing"] {
        let head = ask(stage.address(), path).head;
        for line in [
            "content-security-policy: default-src 'self'",
            "frame-ancestors 'none'",
            "x-content-type-options: nosniff",
            "referrer-policy: no-referrer",
            "cross-origin-resource-policy: same-origin",
        ] {
            assert!(head.contains(line), "{path}: {head}");
        }
        assert!(!head.contains("unsafe-") && !head.contains("access-control"));
    }
}

#[test]
fn with_a_token_nothing_is_told_without_it() {
    let stage = Stage::with(&Options {
        listen: ([127, 0, 0, 1], 0).into(),
        token: true,
        ..Options::default()
    });
    let at = stage.address();
    let url = stage.server.url(at.ip());
    let (_, token) = url.split_once("?token=").unwrap();
    for path in [
        "/api/scene",
        "/api/takes/0/frames?from=0&count=1",
        "/metrics",
        "/api/scene?token=",
        "/ws",
    ] {
        let line = format!("GET {path}");
        assert_eq!(status(at, &line, &[host(at), origin(at)]), 401, "{path}");
        let wrong = format!("Cookie: posewire-{}={}", at.port(), "0".repeat(32));
        assert_eq!(status(at, &line, &[host(at), origin(at), wrong]), 401, "{path}");
    }
    assert!(Page::try_open(at).is_err());
    assert_eq!(ask(at, "/?token=0").status, 401);
    assert_eq!(ask(at, "/").status, 200, "the page itself is no secret");

    let entered = ask(at, &format!("/?token={token}"));
    assert_eq!(entered.status, 303);
    let line = entered
        .head
        .lines()
        .find_map(|line| line.strip_prefix("set-cookie: "))
        .unwrap();
    assert!(line.ends_with("; path=/; httponly; samesite=strict"), "{line}");
    let cookie = format!("Cookie: {}", line.split_once(';').unwrap().0);
    assert_eq!(status(at, "GET /api/scene", &[host(at), cookie]), 200);
    let bearer = format!("Authorization: Bearer {token}");
    assert_eq!(status(at, "GET /metrics", &[host(at), bearer]), 200);
}

#[test]
fn a_page_that_sends_what_it_must_not_is_closed_and_no_other() {
    let stage = Stage::new();
    let mut other = stage.page();
    other.words("scene");
    let bad = [
        Message::text("no JSON"),
        Message::text("[]"),
        Message::text(r#"{"type":"rate"}"#),
        Message::text(r#"{"type":"rate","hz":0}"#),
        Message::text(r#"{"type":"rate","hz":121}"#),
        Message::text(r#"{"type":"rate","hz":-1}"#),
        Message::text(r#"{"type":"rate","hz":30,"and":1}"#),
        Message::text(r#"{"type":"shutdown"}"#),
        Message::text(r#"{"type":"plot","channels":[{"id":70000,"subject":0,"channel":""}]}"#),
        Message::text(format!(
            r#"{{"type":"plot","channels":[{}]}}"#,
            vec![r#"{"id":1,"subject":0,"channel":"a"}"#; 17].join(",")
        )),
        Message::text("[".repeat(60_000)),
        Message::text(" ".repeat(70_000)),
        Message::text(" ".repeat(100_000)),
        Message::text(" ".repeat(3_000_000)),
        Message::binary(vec![1, 2, 3]),
    ];
    let count = bad.len() as u64;
    for message in bad {
        let mut page = stage.page();
        let shown = message.to_string().chars().take(60).collect::<String>();
        page.send_message(message);
        assert_eq!(page.closed(), CloseCode::Policy, "{shown}");
    }
    assert_eq!(stage.metric("posewire_viewer_refused_total{why=\"message\"}"), count);
    other.send(r#"{"type":"rate","hz":120}"#);
    let before = other.tick().number;
    assert_eq!(other.tick().number, before + 1);
    assert_eq!(metric(stage.address(), "posewire_viewer_pages"), 1);
}

#[test]
fn frames_that_are_none_are_counted() {
    let stage = Stage::new();
    // Reserved bits, an operation that there is not, and no mask.
    for frame in [
        [0xf1, 0x80, 0, 0, 0, 0],
        [0x83, 0x80, 0, 0, 0, 0],
        [0x81, 0x01, b'a', 0, 0, 0],
    ] {
        let mut page = stage.page();
        page.send_bytes(&frame);
        page.ended();
    }
    assert_eq!(stage.metric("posewire_viewer_refused_total{why=\"message\"}"), 3);
    drop(stage.page());
    while stage.metric("posewire_viewer_pages") > 0 {}
    assert_eq!(
        stage.metric("posewire_viewer_refused_total{why=\"message\"}"),
        3,
        "who goes is no fault"
    );
}

#[test]
fn a_page_that_does_nothing_but_talk_is_closed() {
    let stage = Stage::new();
    let mut page = stage.page();
    for _ in 0..1000 {
        page.send_message(Message::text(r#"{"type":"rate","hz":30}"#));
    }
    assert_eq!(page.closed(), CloseCode::Policy);
}
