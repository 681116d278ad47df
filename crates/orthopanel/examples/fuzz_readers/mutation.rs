//! Random changes of a few bytes.

/// Marsaglia's xorshift64.
pub struct Random(u64);

/// What readers trip over: marks, numbers at their limits, broken text.
const PIECES: [&[u8]; 22] = [
    b"    -1\n",
    b"-1",
    b"\n",
    b"58b",
    b"nan",
    b"1e999",
    b"-",
    b"0",
    b"9999999999",
    b"18446744073709551615",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"[[",
    b"]",
    b"{",
    b",",
    b"\"",
    b"e",
    b"<",
    b"/>",
    b"&#0;",
    b"PK\x01\x02",
];

impl Random {
    pub fn new(seed: u64) -> Self {
        // Zero is the one state that xorshift never leaves.
        Self(seed.max(1))
    }

    pub fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        // Limits are lengths of small files.
        usize::try_from(self.0 % limit.max(1) as u64).unwrap_or(0)
    }

    /// Repeats some of the bytes where they stand until there are `size`: time or memory that grows faster than the file shows only
    /// in long ones.
    pub fn lengthen(&mut self, bytes: &mut Vec<u8>, size: usize) {
        let line_start = |at: usize| bytes[..at].iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
        let (from, length) = (self.below(bytes.len()), 1 + self.below(200));
        let (mut from, mut end) = (from, (from + length).min(bytes.len()));
        // Whole lines stay rows and tables.
        if self.below(2) == 0 && line_start(end) > line_start(from) {
            (from, end) = (line_start(from), line_start(end));
        }
        let piece = bytes[from..end].to_vec();
        if !piece.is_empty() {
            let times = size.saturating_sub(bytes.len()) / piece.len();
            bytes.splice(from..from, piece.repeat(times));
        }
    }

    pub fn mutate(&mut self, bytes: &mut Vec<u8>) {
        for _ in 0..=self.below(4) {
            let (at, length) = (self.below(bytes.len()), self.below(12));
            let end = (at + length).min(bytes.len());
            match self.below(6) {
                0 => bytes.truncate(at),
                1 => drop(bytes.drain(at..end)),
                2 => {
                    let copy: Vec<u8> = bytes.get(at..end).unwrap_or_default().to_vec();
                    bytes.splice(at..at, copy);
                }
                3 => drop(bytes.splice(at..end, PIECES[self.below(PIECES.len())].iter().copied())),
                4 => drop(bytes.splice(at..at, PIECES[self.below(PIECES.len())].iter().copied())),
                _ => {
                    if let Some(byte) = bytes.get_mut(at) {
                        *byte ^= 1 << self.below(8);
                    }
                }
            }
        }
    }
}
