//! Plans from text.

use super::{Burst, FaultPlan, Rewind, Silence};
use crate::{Error, Result};
use std::str::FromStr;
use std::time::Duration;

impl FromStr for FaultPlan {
    type Err = Error;

    /// # Errors
    /// [`Error::Faults`], which says where in the text what was expected.
    fn from_str(text: &str) -> Result<Self> {
        let mut plan = Self::default();
        let mut seen = Vec::new();
        for piece in text.split(',') {
            let item = Item::split(text, piece)?;
            if item.sign == '=' && seen.contains(&item.name) {
                return Err(item.refuse(item.name, "each share and the seed once"));
            }
            seen.push(item.name);
            plan.add(&item)?;
        }
        plan.resets.sort_unstable();
        plan.rewinds.sort_unstable();
        plan.silences.sort_unstable();
        Ok(plan)
    }
}

impl FaultPlan {
    fn add(&mut self, item: &Item<'_>) -> Result<()> {
        match (item.name, item.sign) {
            ("loss", '=') => self.loss = item.percent(item.value)?,
            ("burst", '=') => self.burst = Some(item.burst()?),
            ("dup", '=') => self.duplicate = item.percent(item.value)?,
            ("reorder", '=') => self.reorder = item.percent(item.value)?,
            ("jitter", '=') => self.jitter = item.jitter()?,
            ("drift", '=') => self.drift_ppm = item.drift()?,
            ("reset", '@') => self.resets.push(item.time(item.value)?),
            ("rewind", '@') => self.rewinds.push(item.rewind()?),
            ("truncate", '=') => self.truncate = item.percent(item.value)?,
            ("flip", '=') => self.flip = item.percent(item.value)?,
            ("nan", '=') => self.nan = item.percent(item.value)?,
            ("silence", '@') => self.silences.push(item.silence()?),
            ("seed", '=') => self.seed = item.number(item.value, "a whole number, as in seed=7")?,
            _ => return Err(item.refuse(item.name, FAULTS)),
        }
        Ok(())
    }
}

/// One fault of a plan as text: `name=value` or `name@value`.
struct Item<'a> {
    text: &'a str,
    name: &'a str,
    sign: char,
    value: &'a str,
}

impl<'a> Item<'a> {
    fn split(text: &'a str, piece: &'a str) -> Result<Self> {
        let piece = piece.trim();
        let cut = piece.find(['=', '@']);
        let (name, value) = piece.split_at(cut.unwrap_or(piece.len()));
        let sign = value.chars().next().unwrap_or(' ');
        let item = Self {
            text,
            name,
            sign,
            value: value.get(1..).unwrap_or(value),
        };
        match cut {
            Some(_) => Ok(item),
            None => Err(item.refuse(piece, FAULTS)),
        }
    }

    fn percent(&self, found: &str) -> Result<f64> {
        let number = found.strip_suffix('%').and_then(|number| number.parse::<f64>().ok());
        let share = number.filter(|percent| (0.0..=100.0).contains(percent));
        share.ok_or_else(|| self.refuse(found, "a share from 0% to 100%, as in 0.5%"))
    }

    fn burst(&self) -> Result<Burst> {
        let expected = "a share and a length, as in 0.1%x20";
        let Some((percent, length)) = self.value.split_once('x') else {
            return Err(self.refuse(self.value, expected));
        };
        let count: u32 = self.number(length, "how many datagrams a burst takes, as in 0.1%x20")?;
        if count == 0 {
            return Err(self.refuse(length, "a burst of at least 1 datagram"));
        }
        Ok(Burst {
            percent: self.percent(percent)?,
            length: count,
        })
    }

    fn jitter(&self) -> Result<Duration> {
        let jitter = self.time(self.value)?;
        if jitter > MAX_JITTER {
            return Err(self.refuse(self.value, "a jitter of at most 10s"));
        }
        Ok(jitter)
    }

    fn drift(&self) -> Result<f64> {
        let number = self.value.strip_suffix("ppm").and_then(|number| number.parse().ok());
        let drift = number.filter(|ppm: &f64| ppm.abs() < 1e6);
        drift.ok_or_else(|| self.refuse(self.value, "parts of a million, as in 200ppm or -50ppm"))
    }

    fn rewind(&self) -> Result<Rewind> {
        let (at, back) = match self.value.split_once('-') {
            Some((at, back)) => (at, self.time(back)?),
            None => (self.value, USUAL_REWIND),
        };
        let at = self.time(at)?;
        Ok(Rewind { at, back })
    }

    fn silence(&self) -> Result<Silence> {
        let Some((at, length)) = self.value.split_once('+') else {
            return Err(self.refuse(self.value, "a time and a length, as in silence@20s+3s"));
        };
        Ok(Silence {
            at: self.time(at)?,
            length: self.time(length)?,
        })
    }

    fn time(&self, found: &str) -> Result<Duration> {
        let units = [("us", 1e6), ("ms", 1e3), ("s", 1.0)];
        let parse = |(unit, per_second): (&str, f64)| {
            let number: f64 = found.strip_suffix(unit)?.parse().ok()?;
            Duration::try_from_secs_f64(number / per_second).ok()
        };
        let time = units.into_iter().find_map(parse);
        time.filter(|time| *time <= MAX_TIME)
            .ok_or_else(|| self.refuse(found, "a time of at most a year, as in 10s, 5ms or 250us"))
    }

    fn number<T: FromStr>(&self, found: &str, expected: &'static str) -> Result<T> {
        found.parse().map_err(|_| self.refuse(found, expected))
    }

    /// `found` is a part of the text.
    fn refuse(&self, found: &str, expected: &'static str) -> Error {
        Error::Faults {
            offset: found.as_ptr() as usize - self.text.as_ptr() as usize,
            expected,
            found: found.to_owned(),
        }
    }
}

const FAULTS: &str = "one of loss=, burst=, dup=, reorder=, jitter=, drift=, reset@, rewind@, truncate=, flip=, nan=, silence@ and seed=";
const USUAL_REWIND: Duration = Duration::from_secs(2);
const MAX_JITTER: Duration = Duration::from_secs(10);
const MAX_TIME: Duration = Duration::from_hours(365 * 24);

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ALL: &str = "loss=1%,burst=0.1%x20,dup=0.5%,reorder=1%,jitter=5ms,drift=200ppm,reset@10s,rewind@15s,\
                       truncate=0.1%,flip=0.01%,nan=0.1%,silence@20s+3s,seed=7";

    fn refused(text: &str) -> (usize, String) {
        match text.parse::<FaultPlan>() {
            Err(Error::Faults { offset, found, .. }) => (offset, found),
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn a_plan_says_all_that_can_go_wrong() {
        let plan: FaultPlan = ALL.parse().unwrap();
        let seconds = Duration::from_secs;
        let expected = FaultPlan {
            loss: 1.0,
            burst: Some(Burst {
                percent: 0.1,
                length: 20,
            }),
            duplicate: 0.5,
            reorder: 1.0,
            jitter: Duration::from_millis(5),
            drift_ppm: 200.0,
            resets: vec![seconds(10)],
            rewinds: vec![Rewind {
                at: seconds(15),
                back: seconds(2),
            }],
            truncate: 0.1,
            flip: 0.01,
            nan: 0.1,
            silences: vec![Silence {
                at: seconds(20),
                length: seconds(3),
            }],
            seed: 7,
        };
        assert_eq!(plan, expected);
        assert_eq!(plan.to_string(), ALL.replace("rewind@15s", "rewind@15s-2s"));
    }

    #[test]
    fn what_happens_at_a_time_may_happen_again() {
        let plan: FaultPlan = "reset@20s, reset@500ms".parse().unwrap();
        assert_eq!(plan.resets, [Duration::from_millis(500), Duration::from_secs(20)]);
    }

    #[test]
    fn an_error_says_where_what_was_found() {
        for (text, offset, found) in [
            ("", 0, ""),
            ("loss", 0, "loss"),
            ("loss=1%,", 8, ""),
            ("loss=1", 5, "1"),
            ("dup=1%,loss=101%", 12, "101%"),
            ("loss=NaN%", 5, "NaN%"),
            ("loss=1%,loss=2%", 8, "loss"),
            ("loss@1s", 0, "loss"),
            ("burst=1%", 6, "1%"),
            ("burst=1%x0", 9, "0"),
            ("jitter=5", 7, "5"),
            ("jitter=-5ms", 7, "-5ms"),
            ("silence@20s", 8, "20s"),
            ("seed=-1", 5, "-1"),
            ("drift=20%", 6, "20%"),
        ] {
            assert_eq!(refused(text), (offset, found.to_owned()), "{text}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn a_plan_reads_as_it_is_printed(
            shares in prop::array::uniform6(0.0..=100.0_f64),
            burst in prop::option::of((0.0..=100.0_f64, 1..100_u32)),
            times in prop::array::uniform5(0..3_000_000_000_000_u64),
            drift_ppm in -1000.0..1000.0_f64,
            seed in any::<u64>(),
        ) {
            let [loss, duplicate, reorder, truncate, flip, nan] = shares;
            let [a, b, c, d, e] = times.map(Duration::from_nanos);
            let plan = FaultPlan {
                loss, duplicate, reorder, truncate, flip, nan, drift_ppm, seed,
                burst: burst.map(|(percent, length)| Burst { percent, length }),
                jitter: a / 1000,
                resets: vec![b],
                rewinds: vec![Rewind { at: c, back: d }],
                silences: vec![Silence { at: d, length: e }],
            };
            prop_assert_eq!(plan.to_string().parse::<FaultPlan>(), Ok(plan));
        }

        #[test]
        fn any_text_is_read_or_refused(text in "\\PC*", items in "([a-z]{0,8}[=@][0-9.%xmsu+-]{0,8},?){0,4}") {
            let _ = text.parse::<FaultPlan>();
            let _ = items.parse::<FaultPlan>();
        }
    }
}
