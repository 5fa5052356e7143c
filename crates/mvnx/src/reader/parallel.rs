//! Parses the frames of a file on several threads.
//!
//! The caller's thread reads the bytes, cuts them into blocks and puts what was parsed together in the file's order; when
//! there is nothing else to do it parses too. A block counts only when it was parsed whole, as normal frames and nothing
//! else, from its first byte, at which the block before it ended between two frames: the reader itself would then have read
//! the same. The first block of which that is not so, and all behind it, are put back for the reader, so that damage is
//! found, told and salvaged by it alone.

use super::blocks::{Block, BlockParser, Cutter};
use super::{Reader, State};
use crate::sections::SectionSummary;
use posewire_motion::Take;
use std::collections::VecDeque;
use std::io::BufRead;
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

/// Adds as many frames as can be read in blocks to `take`. The reader then goes on behind them.
pub(super) fn read_blocks<R: BufRead>(reader: &mut Reader<R>, take: &mut Take, threads: usize, block: usize) {
    let queue = Queue::default();
    let (results, parsed) = mpsc::channel();
    let mut conductor = Conductor {
        cutter: Cutter::new(reader.xml.input().place(), block),
        parser: reader.block_parser(),
        queue: &queue,
        parsed,
        waiting: VecDeque::new(),
        spare: Vec::new(),
        cut: 0,
        appended: 0,
        most: 2 * threads as u64 + 2,
    };
    thread::scope(|scope| {
        for _ in 1..threads {
            let (parser, results, queue) = (reader.block_parser(), results.clone(), &queue);
            scope.spawn(move || work(parser, queue, &results));
        }
        // The workers hold the only senders, so that waiting for a block ends when they do.
        drop(results);
        conductor.run(reader, take);
        queue.close();
    });
    conductor.put_back(reader);
}

/// Parses blocks until the queue is closed.
fn work(mut parser: BlockParser, queue: &Queue, results: &Sender<Block>) {
    while let Some(mut block) = queue.wait() {
        parser.parse(&mut block);
        if results.send(block).is_err() {
            return;
        }
    }
}

/// What the caller's thread does.
struct Conductor<'a> {
    cutter: Cutter,
    parser: BlockParser,
    queue: &'a Queue,
    parsed: Receiver<Block>,
    /// Parsed blocks that wait for one before them; the first is the next one to be appended.
    waiting: VecDeque<Option<Block>>,
    /// Blocks whose memory can be used again.
    spare: Vec<Block>,
    /// Blocks cut off.
    cut: u64,
    /// Blocks appended.
    appended: u64,
    /// The most blocks to be in use at once.
    most: u64,
}

impl Conductor<'_> {
    /// Appends blocks until the file ends or one is not plain.
    fn run<R: BufRead>(&mut self, reader: &mut Reader<R>, take: &mut Take) {
        let mut more = true;
        loop {
            while let Ok(block) = self.parsed.try_recv() {
                self.keep(block);
            }
            if !self.append(reader, take) {
                return;
            }
            if more && self.cut - self.appended < self.most {
                more = self.cut_off(reader);
            } else if self.cut == self.appended {
                return;
            } else if let Some(mut block) = self.queue.take() {
                self.parser.parse(&mut block);
                self.keep(block);
            } else if let Ok(block) = self.parsed.recv() {
                self.keep(block);
            } else {
                return;
            }
        }
    }

    /// Hands the next block of the file to the workers; `false` when there is none.
    fn cut_off<R: BufRead>(&mut self, reader: &mut Reader<R>) -> bool {
        let mut block = self.spare.pop().unwrap_or_else(|| reader.new_block());
        let found = self.cutter.cut(reader.xml.input().rest(), &mut block);
        if found {
            self.cut += 1;
            self.waiting.push_back(None);
            self.queue.give(block);
        }
        found
    }

    /// Keeps a parsed block until its turn has come.
    fn keep(&mut self, block: Block) {
        let place = (block.number - self.appended) as usize;
        if let Some(slot) = self.waiting.get_mut(place) {
            *slot = Some(block);
        }
    }

    /// Adds the parsed blocks whose turn has come to the take; `false` when one is not plain.
    fn append<R: BufRead>(&mut self, reader: &mut Reader<R>, take: &mut Take) -> bool {
        while let Some(slot @ Some(_)) = self.waiting.front_mut() {
            let Some(mut block) = slot.take_if(|block| block.plain) else {
                return false;
            };
            if !reader.frames.summary.append(std::mem::take(&mut block.sections)) {
                block.plain = false;
                *slot = Some(block);
                return false;
            }
            reader.counts.normal += block.take.len() as u64;
            // Its sections are those of the same file.
            let _ = take.append(&mut block.take);
            self.waiting.pop_front();
            self.appended += 1;
            self.spare.push(block);
        }
        true
    }

    /// Gives the bytes that were not appended back to the reader. The workers have ended.
    fn put_back<R: BufRead>(mut self, reader: &mut Reader<R>) {
        while let Some(block) = self.queue.take().or_else(|| self.parsed.try_recv().ok()) {
            self.keep(block);
        }
        let (rest, mut place) = self.cutter.into_rest();
        let blocks: Vec<Block> = self.waiting.into_iter().flatten().collect();
        place = blocks.first().map_or(place, |block| block.place);
        let mut bytes: Vec<u8> = blocks.into_iter().flat_map(|block| block.bytes).collect();
        bytes.extend(rest);
        let input = reader.xml.input();
        input.set_place(place);
        input.rest().put_back(bytes);
    }
}

impl<R: BufRead> Reader<R> {
    /// Whether the reader stands between two frames, and all that was put back has been read.
    pub(super) fn can_take_blocks(&mut self) -> bool {
        matches!(self.state, State::Between) && !self.xml.input().rest().comes_again()
    }

    fn block_parser(&self) -> BlockParser {
        BlockParser::new(self.frames.another(), &self.subject)
    }

    fn new_block(&mut self) -> Block {
        Block {
            number: 0,
            place: self.xml.place(),
            bytes: Vec::new(),
            take: Take::new(Arc::clone(&self.subject), 0.0),
            sections: SectionSummary::default(),
            plain: false,
        }
    }
}

/// Blocks to be parsed.
#[derive(Default)]
struct Queue {
    state: Mutex<QueueState>,
    given: Condvar,
}

#[derive(Default)]
struct QueueState {
    blocks: VecDeque<Block>,
    closed: bool,
}

impl Queue {
    fn give(&self, block: Block) {
        self.lock().blocks.push_back(block);
        self.given.notify_one();
    }

    /// The next block if there is one.
    fn take(&self) -> Option<Block> {
        self.lock().blocks.pop_front()
    }

    /// The next block when there is one; `None` when there will be no more that are worth parsing.
    fn wait(&self) -> Option<Block> {
        let waiting = |state: &mut QueueState| state.blocks.is_empty() && !state.closed;
        let state = self.given.wait_while(self.lock(), waiting);
        let mut state = state.unwrap_or_else(PoisonError::into_inner);
        if state.closed { None } else { state.blocks.pop_front() }
    }

    fn close(&self) {
        self.lock().closed = true;
        self.given.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, QueueState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
