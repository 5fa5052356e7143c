//! Requests that are not granted: counted, and answered with what is wrong and what to do.

use crate::Error;
use crate::app::App;
use crate::guard::Refusal;
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use serde::Serialize;

/// The answer to a request that is not granted.
#[derive(Debug)]
pub(crate) struct Refused {
    status: StatusCode,
    error: String,
    help: String,
}

impl Refused {
    /// There is no such thing.
    pub(crate) fn missing(app: &App) -> Self {
        let help = "GET /api/scene says what there is";
        Self::new(app, StatusCode::NOT_FOUND, "nothing is here", help)
    }

    /// The request lacks what it needs.
    pub(crate) fn malformed(app: &App, expected: &str) -> Self {
        let help = "docs/viewer.md says how each request looks";
        Self::new(app, StatusCode::BAD_REQUEST, format!("expected {expected}"), help)
    }

    /// What was asked for cannot be given.
    pub(crate) fn of(app: &App, error: &Error) -> Self {
        let status = match error {
            Error::TooManyFrames { .. } => StatusCode::BAD_REQUEST,
            _ => StatusCode::NOT_FOUND,
        };
        Self::new(app, status, error.to_string(), error.help().unwrap_or_default())
    }

    /// An answer, which is counted.
    pub(crate) fn new(app: &App, status: StatusCode, error: impl Into<String>, help: impl Into<String>) -> Self {
        app.counts.refused.request.add(1);
        Self {
            status,
            error: error.into(),
            help: help.into(),
        }
    }
}

/// The answer to who is not to be answered.
pub(crate) fn refuse(app: &App, refusal: Refusal) -> Refused {
    let refused = &app.counts.refused;
    let (count, status, error, help) = match refusal {
        Refusal::Host => (
            &refused.host,
            StatusCode::MISDIRECTED_REQUEST,
            "this server has another name",
            "use the address that posewire printed",
        ),
        Refusal::Origin => (
            &refused.origin,
            StatusCode::FORBIDDEN,
            "only this server's own page is answered",
            "use the page at the address that posewire printed",
        ),
        Refusal::Token => (
            &refused.token,
            StatusCode::UNAUTHORIZED,
            "the token is missing or wrong",
            "open the whole address that posewire printed, with ?token=, or scan its code",
        ),
    };
    count.add(1);
    Refused {
        status,
        error: error.to_owned(),
        help: help.to_owned(),
    }
}

impl IntoResponse for Refused {
    fn into_response(self) -> Response {
        #[derive(Serialize)]
        struct Body<'a> {
            error: &'a str,
            help: &'a str,
        }
        let body = Body {
            error: &self.error,
            help: &self.help,
        };
        let body = serde_json::to_string(&body).unwrap_or_default();
        (self.status, [(CONTENT_TYPE, "application/json")], body).into_response()
    }
}
