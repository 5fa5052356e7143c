//! What is answered over HTTP.

use crate::app::App;
use crate::guard::{Guard, Refusal};
use crate::page::{self, MOST_MESSAGE};
use crate::refusal::{Refused, refuse};
use crate::room::Guest;
use crate::{Content, Takes, assets, metrics, recordings};
use axum::Router;
use axum::extract::rejection::{PathRejection, QueryRejection};
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::{DefaultBodyLimit, Path, Query, Request, State};
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE, HeaderMap, LOCATION, SET_COOKIE};
use axum::http::{Method, StatusCode};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

pub(crate) type Shared = State<Arc<App>>;
pub(crate) type Answer = Result<Response, Refused>;

/// Everything that is answered.
pub(crate) fn router(app: &Arc<App>) -> Router {
    let guarded = Router::new()
        .route("/api/scene", get(scene))
        .route("/api/takes/{take}/frames", get(frames))
        .route("/api/takes/{take}/series", get(series))
        .route("/api/recorder", get(recordings::status))
        .route("/api/recorder/start", post(recordings::start))
        .route("/api/recorder/stop", post(recordings::stop))
        .route("/api/recordings", get(recordings::list))
        .route("/api/recordings/{name}", get(recordings::fetch))
        .route("/metrics", get(metrics))
        .route("/ws", get(socket))
        .layer(middleware::from_fn_with_state(Arc::clone(app), check_token));
    guarded
        .route("/", get(index))
        .route("/healthz", get("ok"))
        .fallback(asset)
        .layer(DefaultBodyLimit::max(MOST_MESSAGE))
        .layer(middleware::from_fn_with_state(Arc::clone(app), check_sender))
        .with_state(Arc::clone(app))
}

/// Refuses what is not of this host and of its page, and gives every answer its headers.
async fn check_sender(State(app): Shared, request: Request, next: Next) -> Response {
    let headers = request.headers();
    let is_reading = matches!(*request.method(), Method::GET | Method::HEAD);
    let changes = !is_reading || request.uri().path() == "/ws";
    let checked = app.guard.check_host(request.uri(), headers);
    let checked = checked.and_then(|()| Guard::check_origin(headers, changes));
    let is_trustworthy = Guard::is_of_this_machine(headers);
    let mut response = match checked {
        Ok(()) => next.run(request).await,
        Err(refusal) => refuse(&app, refusal).into_response(),
    };
    assets::protect(&mut response, is_trustworthy);
    response
}

async fn check_token(State(app): Shared, request: Request, next: Next) -> Response {
    match app.guard.check_token(request.headers()) {
        Ok(()) => {
            if let Some(guest) = request.extensions().get::<Arc<Guest>>() {
                guest.is_page();
            }
            next.run(request).await
        }
        Err(refusal) => refuse(&app, refusal).into_response(),
    }
}

#[derive(Deserialize)]
struct Entry {
    token: Option<String>,
}

/// The page. With the right token behind it the address gives the cookie, and is not the address any more.
async fn index(State(app): Shared, entry: Result<Query<Entry>, QueryRejection>) -> Answer {
    let given = entry.ok().and_then(|Query(entry)| entry.token);
    let (Some(given), Some(token)) = (given, app.guard.token()) else {
        return Ok(assets::index());
    };
    if !token.is(&given) {
        return Err(refuse(&app, Refusal::Token));
    }
    let cookie = format!(
        "{}={}; Path=/; HttpOnly; SameSite=Strict",
        app.guard.cookie(),
        token.digits()
    );
    let headers = [
        (LOCATION, "/".to_owned()),
        (SET_COOKIE, cookie),
        (CACHE_CONTROL, "no-store".to_owned()),
    ];
    Ok((StatusCode::SEE_OTHER, headers).into_response())
}

async fn asset(State(app): Shared, request: Request) -> Answer {
    let is_reading = matches!(*request.method(), Method::GET | Method::HEAD);
    let found = is_reading.then(|| assets::asset(request.uri().path())).flatten();
    found.ok_or_else(|| Refused::missing(&app))
}

async fn scene(State(app): Shared) -> Response {
    json_text(app.scene(false))
}

#[derive(Deserialize)]
struct Range {
    from: usize,
    count: usize,
}

async fn frames(
    State(app): Shared,
    take: Result<Path<u32>, PathRejection>,
    range: Result<Query<Range>, QueryRejection>,
) -> Answer {
    let (Ok(Path(take)), Ok(Query(range))) = (take, range) else {
        return Err(Refused::malformed(&app, "a take's number, from and count"));
    };
    let records = takes(&app)?.frames(take, range.from, range.count);
    records.map(bytes).map_err(|error| Refused::of(&app, &error))
}

#[derive(Deserialize)]
struct Named {
    channel: String,
}

async fn series(
    State(app): Shared,
    take: Result<Path<u32>, PathRejection>,
    channel: Result<Query<Named>, QueryRejection>,
) -> Answer {
    let (Ok(Path(take)), Ok(Query(named))) = (take, channel) else {
        return Err(Refused::malformed(&app, "a take's number and a channel"));
    };
    let takes = takes(&app)?.clone();
    let work = tokio::task::spawn_blocking(move || takes.series(take, &named.channel));
    let series = work.await.map_err(|_| Refused::missing(&app))?;
    series.map(bytes).map_err(|error| Refused::of(&app, &error))
}

async fn metrics(State(app): Shared) -> Response {
    let headers = [(CONTENT_TYPE, "text/plain; version=0.0.4; charset=utf-8")];
    (headers, metrics::text(&app)).into_response()
}

async fn socket(State(app): Shared, upgrade: Result<WebSocketUpgrade, WebSocketUpgradeRejection>) -> Answer {
    let upgrade = upgrade.map_err(|_| Refused::malformed(&app, "a WebSocket"))?;
    let upgrade = upgrade.max_message_size(MOST_MESSAGE).max_frame_size(MOST_MESSAGE);
    Ok(upgrade.on_upgrade(move |socket| page::serve(socket, app)))
}

fn takes(app: &App) -> Result<&Takes, Refused> {
    match &app.content {
        Content::Takes(takes) => Ok(takes),
        Content::Live(_) => Err(Refused::missing(app)),
    }
}

/// An answer in JSON.
pub(crate) fn json(value: &impl Serialize) -> Response {
    json_text(serde_json::to_string(value).unwrap_or_default())
}

fn json_text(text: String) -> Response {
    let mut headers = HeaderMap::new();
    headers.insert(CONTENT_TYPE, axum::http::HeaderValue::from_static("application/json"));
    headers.insert(CACHE_CONTROL, axum::http::HeaderValue::from_static("no-store"));
    (headers, text).into_response()
}

fn bytes(bytes: Vec<u8>) -> Response {
    ([(CONTENT_TYPE, "application/octet-stream")], bytes).into_response()
}
