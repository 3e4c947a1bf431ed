//! `denavit view`: the results of a folder on one page, kept up to date.

use super::Answer;
use super::failure::Failure;
use super::outputs::{check_outputs, say_written, write_whole};
use clap::Args;
use denavit::report::Gallery;
use std::fs::File;
use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};
use tiny_http::{Header, Method, Request, Response, Server, StatusCode};

/// Look at the results of a folder: one page that lists them, and follows what changes
///
/// The page is served to this computer alone, until the command is stopped. It lists pages,
/// pictures, JSON, CSV and LaTeX, also in folders below, and is made anew when a file changes.
/// Hidden files, links and whatever else is there are not handed out.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  denavit view . -o index.html")]
pub(crate) struct Arguments {
    /// The folder
    folder: PathBuf,
    /// The port of the address; one that is free by default
    #[arg(long, value_name = "PORT", default_value = "0", hide_default_value = true)]
    port: u16,
    /// Write the page once to this file of the folder, and serve nothing
    #[arg(short, long, value_name = "FILE", conflicts_with = "port")]
    output: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let folder = &arguments.folder;
    let failed = |error| Failure::Folder(folder.display().to_string(), error);
    let gallery = Gallery::read(folder).map_err(failed)?;
    if let Some(output) = &arguments.output {
        // links of the page begin where it is
        let beside = output.parent().unwrap_or(output);
        let beside = if beside.as_os_str().is_empty() { Path::new(".") } else { beside };
        let is_inside =
            output.as_os_str() == "-" || beside.canonicalize().ok() == folder.canonicalize().ok();
        if !is_inside {
            let shown = |path: &Path| path.display().to_string();
            return Err(Failure::Outside(shown(output), shown(folder)));
        }
        let own = output.file_name().unwrap_or_default().to_string_lossy();
        let gallery = gallery.without(&own);
        let outputs = [Some(output)];
        check_outputs(&outputs)?;
        for file in outputs.iter().flatten() {
            write_whole(file, gallery.page(false).render().as_bytes())?;
        }
        say_written(out, &outputs)?;
        return Ok(Answer::Done);
    }
    let server = Server::http(("127.0.0.1", arguments.port));
    let server = server.map_err(|error| Failure::Serve(arguments.port, error.to_string()))?;
    let port = server.server_addr().to_ip().map_or(arguments.port, |address| address.port());
    writeln!(out, "{}: http://127.0.0.1:{port}/ until this is stopped", folder.display())?;
    out.flush()?;
    for request in server.incoming_requests() {
        // a browser that is gone wants no answer
        let _ = answered(request, folder, port);
    }
    Ok(Answer::Done)
}

fn answered(request: Request, folder: &Path, port: u16) -> io::Result<()> {
    // a page of elsewhere, whose name leads here, must not read results
    let names = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    let host = request.headers().iter().find(|header| header.field.equiv("Host"));
    let is_own = host.is_some_and(|host| names.iter().any(|name| host.value.as_str() == name));
    let is_read = matches!(request.method(), Method::Get | Method::Head);
    if !is_own || !is_read {
        return request.respond(text(403, "denied", "text/plain"));
    }
    let Ok(gallery) = Gallery::read(folder) else {
        return request.respond(text(404, "the folder is gone", "text/plain"));
    };
    match request.url() {
        "/" => {
            let page = gallery.page(true).render();
            request.respond(text(200, &page, "text/html; charset=utf-8"))
        }
        "/stamp" => request.respond(text(200, &gallery.stamp(), "text/plain")),
        url => match gallery.file(url).map(|(path, kind)| (File::open(path), kind)) {
            Some((Ok(file), kind)) => {
                request.respond(with_headers(Response::from_file(file), kind))
            }
            _ => request.respond(text(404, "there is no such result", "text/plain")),
        },
    }
}

fn text(status: u16, text: &str, kind: &str) -> Response<Cursor<Vec<u8>>> {
    with_headers(Response::from_string(text).with_status_code(StatusCode(status)), kind)
}

fn with_headers<R: io::Read>(mut response: Response<R>, kind: &str) -> Response<R> {
    let all = [
        ("Content-Type", kind),
        ("X-Content-Type-Options", "nosniff"),
        ("Cache-Control", "no-store"),
    ];
    for (name, value) in all {
        response.add_header(Header::from_bytes(name, value).expect("plain letters"));
    }
    response
}
