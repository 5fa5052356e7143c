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
use std::fmt::Write;
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
    let body = body.map_err(|error| unread(&app, &error))?;
    let Ok(start) = serde_json::from_slice::<Start>(&body) else {
        return Err(Refused::malformed(&app, "the take's name, as in {\"name\":\"walk\"}"));
    };
    act(&app, move || {
        recorder.begin(&start.name)?;
        Ok(recorder.record())
    })
    .await
}

/// A body that is too long, or did not come.
fn unread(app: &App, error: &BytesRejection) -> Refused {
    let status = error.status();
    let problem = if status == StatusCode::PAYLOAD_TOO_LARGE {
        "a body has at most 64 KiB"
    } else {
        "the body did not come to its end"
    };
    Refused::new(
        app,
        status,
        problem,
        "send the take's name alone, as in {\"name\":\"walk\"}",
    )
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
    let headers = [
        (CONTENT_TYPE, "application/octet-stream".to_owned()),
        (CONTENT_LENGTH, length.to_string()),
        (CONTENT_DISPOSITION, disposition(&name)),
    ];
    Ok((headers, pieces(file, length)).into_response())
}

/// A download that is saved by this name, whatever it is written in (RFC 6266), and for programs that read no other, by its
/// plain characters.
fn disposition(name: &str) -> String {
    let is_plain = |one: char| (one.is_ascii_graphic() || one == ' ') && !matches!(one, '"' | '\\' | '%');
    let plain: String = name.chars().map(|one| if is_plain(one) { one } else { '_' }).collect();
    format!("attachment; filename=\"{plain}\"; filename*=UTF-8''{}", encoded(name))
}

/// A text as RFC 5987 writes it.
fn encoded(text: &str) -> String {
    let mut encoded = String::with_capacity(text.len());
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~".contains(&byte) {
            encoded.push(char::from(byte));
        } else {
            // A string takes whatever is written.
            let _ = write!(encoded, "%{byte:02X}");
        }
    }
    encoded
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn downloads_keep_their_names() {
        for (name, expected) in [
            ("walk.mcap", "filename=\"walk.mcap\"; filename*=UTF-8''walk.mcap"),
            (
                "Gang \"3\".mcap",
                "filename=\"Gang _3_.mcap\"; filename*=UTF-8''Gang%20%223%22.mcap",
            ),
            ("步.mcap", "filename=\"_.mcap\"; filename*=UTF-8''%E6%AD%A5.mcap"),
            ("a\r\nb.mcap", "filename=\"a__b.mcap\"; filename*=UTF-8''a%0D%0Ab.mcap"),
        ] {
            assert_eq!(disposition(name), format!("attachment; {expected}"));
        }
    }
}
