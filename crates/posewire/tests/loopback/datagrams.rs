//! Datagrams reach whoever wants them as they came, from several sources at once.

use crate::harness::{PATIENCE, open};
use posewire::endpoint::Endpoint;
use posewire::sink::{NatNetSink, NatNetSinkOptions};
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Datagram, Item, Result, Session, Sink, Source, SourceId, Wants, Wire};
use std::net::UdpSocket;
use std::sync::{Arc, Condvar, Mutex};

pub(crate) type Arrived = Vec<(SourceId, Arc<Datagram>)>;

/// Keeps every datagram.
#[derive(Clone, Default)]
pub(crate) struct Raw(Arc<(Mutex<Arrived>, Condvar)>);

impl Raw {
    pub(crate) fn wait_until(&self, enough: impl Fn(&Arrived) -> bool) -> Arrived {
        let arrived = self.0.0.lock().unwrap();
        let waited = self
            .0
            .1
            .wait_timeout_while(arrived, PATIENCE, |arrived| !enough(arrived));
        let (arrived, timeout) = waited.unwrap();
        assert!(!timeout.timed_out(), "only {} datagrams have come", arrived.len());
        arrived.clone()
    }
}

impl Sink for Raw {
    fn wants(&self) -> Wants {
        Wants {
            frames: false,
            datagrams: true,
            ahead: false,
        }
    }

    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        match item {
            Item::Datagram(datagram) => self.0.0.lock().unwrap().push((source, Arc::clone(datagram))),
            Item::Subject(_) | Item::Frame { .. } => panic!("frames are not wanted"),
            _ => {}
        }
        self.0.1.notify_all();
        Ok(())
    }
}

#[test]
fn each_source_hands_on_what_it_received_even_if_it_cannot_be_read() {
    let sources = [open("mxtp://127.0.0.1:0").unwrap(), open("mxtp://127.0.0.1:0").unwrap()];
    let ports = sources.each_ref().map(|source| match source.endpoint() {
        Endpoint::MxtpUdp(address) => address.port,
        other => panic!("{other}"),
    });
    let (raw, stop) = (Raw::default(), Stop::new());
    let session = Session::start(sources, vec![Box::new(raw.clone())], stop.clone());
    let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
    for (port, bytes) in [(ports[0], "first"), (ports[1], "second"), (ports[1], "")] {
        sender.send_to(bytes.as_bytes(), ("127.0.0.1", port)).unwrap();
    }
    let mut arrived = raw.wait_until(|arrived| arrived.len() >= 3);
    stop.stop();
    session.wait().unwrap();

    arrived.sort_by_key(|(source, _)| *source);
    let seen: Vec<_> = arrived
        .iter()
        .map(|(source, datagram)| (source.0, &*datagram.bytes))
        .collect();
    assert_eq!(seen, [(0, &b"first"[..]), (1, b"second"), (1, b"")]);
    for (source, datagram) in arrived {
        assert_eq!(
            (datagram.wire, datagram.from),
            (Wire::MxtpUdp, sender.local_addr().unwrap())
        );
        assert_eq!(datagram.to.port(), ports[usize::from(source.0)]);
        assert!(datagram.received.nanoseconds() > 0);
    }
}

#[test]
fn natnet_hands_on_answers_and_frames() {
    let url = "natnet://127.0.0.1:0?data-port=0";
    let Endpoint::NatNet(address) = url.parse().unwrap() else {
        panic!("{url} is not NatNet")
    };
    let sink = NatNetSink::open(&address, NatNetSinkOptions::default()).unwrap();
    let server = sink.progress().lock().unwrap().targets[0].endpoint.clone();
    let walkers = Source::open(&"synthetic:walk".parse().unwrap(), &PlaybackOptions::default()).unwrap();
    let (raw, stop) = (Raw::default(), Stop::new());
    let serving = Session::start([walkers], vec![Box::new(sink)], stop.clone());
    let receiving = Session::start([open(&server).unwrap()], vec![Box::new(raw.clone())], stop.clone());
    let kinds = |arrived: &Arrived| -> Vec<u8> { arrived.iter().map(|(_, datagram)| datagram.bytes[0]).collect() };
    // Server information, model and frame of data.
    let arrived = raw.wait_until(|arrived| [1, 5, 7].iter().all(|kind| kinds(arrived).contains(kind)));
    stop.stop();
    receiving.wait().unwrap();
    serving.wait().unwrap();
    assert!(arrived.iter().all(|(_, datagram)| datagram.wire == Wire::NatNetCommand));
}

#[test]
fn a_stream_is_cut_into_its_datagrams() {
    let source = open("mxtp+tcp://127.0.0.1:0").unwrap();
    let target = source.endpoint().clone();
    let (raw, stop) = (Raw::default(), Stop::new());
    let session = Session::start([source], vec![Box::new(raw.clone())], stop.clone());
    let sink = posewire::sink::MxtpSink::open(&[target], crate::harness::types("02")).unwrap();
    crate::harness::play("synthetic:walk", &crate::harness::seconds(0.1), sink);
    let arrived = raw.wait_until(|arrived| arrived.len() >= 6);
    stop.stop();
    session.wait().unwrap();
    for (_, datagram) in arrived {
        assert_eq!(datagram.wire, Wire::MxtpTcp);
        posewire_mxtp::Datagram::decode(&datagram.bytes).unwrap();
    }
}
