//! What is answered about the recorder.

use crate::app::App;
use crate::recorder::{self, Recorder, RecorderRecord};
use crate::refusal::Refused;
use crate::routes::{Answer, Shared, json};
use axum::body::{Body, Bytes};
use axum::extract::rejection::{BytesRejection, PathRejection};
use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_LENGTH, CONTENT_TYPE};
use axum::response::{IntoResponse, Response};
use futures_util::stream;
use serde::Deserialize;
use std::fs::File;
use std::io::{self, Read};
use tokio::task::spawn_blocking;

/// What the recorder does.
pub(crate) async fn status(State(app): Shared) -> Response {
    let Some(recorder) = app.recorder.clone() else {
        return json(&RecorderRecord::default());
    };
    let record = spawn_blocking(move || recorder.record()).await;
    json(&record.unwrap_or_default())
}

#[derive(Deserialize)]
struct Start {
    name: String,
}

/// Begins a take.
pub(crate) async fn start(State(app): Shared, body: Result<Bytes, BytesRejection>) -> Answer {
    let recorder = recorder(&app)?;
    let start = body.ok().and_then(|body| serde_json::from_slice::<Start>(&body).ok());
    let Some(start) = start else {
        return Err(Refused::malformed(&app, "the take's name, as in {\"name\":\"walk\"}"));
    };
    act(&app, move || {
        recorder.begin(&start.name)?;
        Ok(recorder.record())
    })
    .await
}

/// Ends the take.
pub(crate) async fn stop(State(app): Shared) -> Answer {
    let recorder = recorder(&app)?;
    act(&app, move || {
        recorder.end()?;
        Ok(recorder.record())
    })
    .await
}

/// The recordings in the folder.
pub(crate) async fn list(State(app): Shared) -> Answer {
    let recorder = recorder(&app)?;
    let listed = spawn_blocking(move || recorder.recordings()).await;
    Ok(json(&listed.unwrap_or_default()))
}

/// One of them, whole.
pub(crate) async fn fetch(State(app): Shared, name: Result<Path<String>, PathRejection>) -> Answer {
    let recorder = recorder(&app)?;
    let Ok(Path(name)) = name else {
        return Err(Refused::missing(&app));
    };
    let asked = name.clone();
    let opened = spawn_blocking(move || recorder.open(&asked)).await;
    let Ok(Ok(Some((file, length)))) = opened else {
        return Err(Refused::missing(&app));
    };
    // A listed name has no control characters worth keeping; a quote would end it.
    let plain: String = name
        .chars()
        .filter(|&one| one.is_ascii_graphic() && one != '"')
        .collect();
    let headers = [
        (CONTENT_TYPE, "application/octet-stream".to_owned()),
        (CONTENT_LENGTH, length.to_string()),
        (CONTENT_DISPOSITION, format!("attachment; filename=\"{plain}\"")),
    ];
    Ok((headers, pieces(file, length)).into_response())
}

/// A file as it was when it was opened: one that is being written may have grown.
fn pieces(file: File, length: u64) -> Body {
    let next = |mut file: io::Take<File>| async {
        let read = spawn_blocking(move || {
            let mut piece = Vec::with_capacity(PIECE);
            let count = file.by_ref().take(PIECE as u64).read_to_end(&mut piece)?;
            Ok::<_, io::Error>((count > 0).then_some((Bytes::from(piece), file)))
        });
        read.await.map_err(io::Error::other)?
    };
    Body::from_stream(stream::try_unfold(file.take(length), next))
}

/// Does what waits for the disk on a thread that may wait.
async fn act(app: &App, work: impl FnOnce() -> Result<RecorderRecord, recorder::Refused> + Send + 'static) -> Answer {
    let done = spawn_blocking(work).await;
    let broken = || recorder::Refused::State("the recorder has broken down".to_owned());
    match done.map_err(|_| broken()).flatten() {
        Ok(record) => Ok(json(&record)),
        Err(refused) => Err(refusal(app, refused)),
    }
}

fn refusal(app: &App, refused: recorder::Refused) -> Refused {
    match refused {
        recorder::Refused::Name(error) => Refused::new(
            app,
            StatusCode::BAD_REQUEST,
            error,
            "use letters, digits, spaces, - and _",
        ),
        recorder::Refused::State(error) => Refused::new(
            app,
            StatusCode::CONFLICT,
            error,
            "GET /api/recorder says what is recorded",
        ),
        recorder::Refused::Write { error, help } => {
            let help = help.unwrap_or_else(|| "see what the folder's disk says".to_owned());
            Refused::new(app, StatusCode::INTERNAL_SERVER_ERROR, error, help)
        }
    }
}

/// The recorder, where the server was given one.
fn recorder(app: &App) -> Result<Recorder, Refused> {
    app.recorder.clone().ok_or_else(|| {
        let help = "start posewire view with --record-dir";
        Refused::new(app, StatusCode::NOT_FOUND, "nothing is recorded from the page", help)
    })
}

const PIECE: usize = 64 * 1024;
