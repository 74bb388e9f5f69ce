//! Animated pictures (GIF), their colours those that occur most in all of them.

use std::collections::HashMap;

use anyhow::{Context, Result, ensure};
use gif::{DisposalMethod, Encoder, Frame, Repeat};

/// Colours of an animation. One more index stands for what was there before, so that still parts take no room.
const COLOURS: usize = 255;
const AS_BEFORE: u8 = 255;

/// Colours count as one where the leading bits of their channels agree.
const LOST_BITS: u8 = 2;

/// Pictures of one size that follow each other.
#[derive(Clone, Debug, Default)]
pub struct Animation {
    size: [u16; 2],
    /// Red, green and blue of each pixel, row by row.
    pictures: Vec<Vec<u8>>,
}

impl Animation {
    /// Adds a picture: rows of red, green and blue.
    ///
    /// # Errors
    /// It is larger than a GIF can be, or not as large as the ones before.
    pub fn add(&mut self, (width, height, pixels): (u32, u32, Vec<u8>)) -> Result<()> {
        let size = [u16::try_from(width)?, u16::try_from(height)?];
        ensure!(self.pictures.is_empty() || self.size == size, "expected pictures of one size");
        ensure!(pixels.len() == 3 * width as usize * height as usize, "expected 3 bytes for each pixel");
        self.size = size;
        self.pictures.push(pixels);
        Ok(())
    }

    /// The GIF, which begins again at its end; each picture stays for `delay` hundredths of a second, the last for `last`.
    ///
    /// # Errors
    /// There is no picture, or it cannot be encoded.
    pub fn encode(&self, delay: u16, last: u16) -> Result<Vec<u8>> {
        ensure!(!self.pictures.is_empty(), "expected at least 1 picture");
        let palette = Palette::of(&self.pictures);
        let mut nearest = HashMap::new();
        let mut bytes = Vec::new();
        let [width, height] = self.size;
        let mut encoder = Encoder::new(&mut bytes, width, height, &palette.bytes()).context("the GIF cannot begin")?;
        encoder.set_repeat(Repeat::Infinite)?;
        let mut before: Vec<u8> = Vec::new();
        for (k, picture) in self.pictures.iter().enumerate() {
            let indices: Vec<u8> = picture.chunks_exact(3).map(|pixel| palette.index(pixel, &mut nearest)).collect();
            let changed = |(i, &index): (usize, &u8)| if before.get(i) == Some(&index) { AS_BEFORE } else { index };
            let shown: Vec<u8> = indices.iter().enumerate().map(changed).collect();
            let frame = Frame {
                width,
                height,
                delay: if k + 1 == self.pictures.len() { last } else { delay },
                dispose: DisposalMethod::Keep,
                transparent: Some(AS_BEFORE),
                buffer: shown.into(),
                ..Frame::default()
            };
            encoder.write_frame(&frame)?;
            before = indices;
        }
        drop(encoder);
        Ok(bytes)
    }
}

struct Palette(Vec<[u8; 3]>);

/// What colours count as one.
fn bucket(pixel: &[u8]) -> [u8; 3] {
    [0, 1, 2].map(|k| pixel[k] >> LOST_BITS)
}

impl Palette {
    /// The most frequent colours, each the mean of those that count as it.
    fn of(pictures: &[Vec<u8>]) -> Self {
        let mut counts: HashMap<[u8; 3], (u64, [u64; 3])> = HashMap::new();
        for pixel in pictures.iter().flat_map(|picture| picture.chunks_exact(3)) {
            let (count, sums) = counts.entry(bucket(pixel)).or_default();
            *count += 1;
            (0..3).for_each(|k| sums[k] += u64::from(pixel[k]));
        }
        let mut buckets: Vec<_> = counts.into_iter().collect();
        buckets.sort_by_key(|(bucket, (count, _))| (std::cmp::Reverse(*count), *bucket));
        let mean = |(count, sums): (u64, [u64; 3])| sums.map(|sum| ((sum + count / 2) / count) as u8);
        Self(buckets.into_iter().take(COLOURS).map(|(_, found)| mean(found)).collect())
    }

    fn bytes(&self) -> Vec<u8> {
        let mut bytes: Vec<u8> = self.0.iter().flatten().copied().collect();
        // The last index is there too, though it has no colour.
        bytes.resize(3 * (COLOURS + 1), 0);
        bytes
    }

    /// The nearest colour to that of a pixel.
    fn index(&self, pixel: &[u8], found: &mut HashMap<[u8; 3], u8>) -> u8 {
        *found.entry(bucket(pixel)).or_insert_with(|| {
            let apart = |colour: &[u8; 3]| {
                (0..3).map(|k| i32::from(colour[k]).abs_diff(i32::from(pixel[k])).pow(2)).sum::<u32>()
            };
            let nearest = (0..self.0.len()).min_by_key(|&i| apart(&self.0[i]));
            nearest.map_or(0, |i| i as u8)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// White, with a red column at `x`.
    fn picture(x: usize) -> (u32, u32, Vec<u8>) {
        let pixel = |i: usize| if i % 8 == x { [200, 20, 30] } else { [255, 255, 255] };
        (8, 4, (0..32).flat_map(pixel).collect())
    }

    #[test]
    fn what_is_encoded_reads_back() {
        let mut animation = Animation::default();
        (0..3).for_each(|x| animation.add(picture(2 * x)).unwrap());
        let bytes = animation.encode(8, 100).unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes.as_slice()).unwrap();
        assert_eq!((decoder.width(), decoder.height()), (8, 4));
        let (mut shown, mut delays) = (vec![0; 128], Vec::new());
        for k in 0..3 {
            let frame = decoder.read_next_frame().unwrap().unwrap();
            delays.push(frame.delay);
            // What is transparent stays as it was.
            for (old, new) in shown.chunks_exact_mut(4).zip(frame.buffer.chunks_exact(4)) {
                if new[3] > 0 {
                    old.copy_from_slice(new);
                }
            }
            let expected: Vec<u8> = picture(2 * k).2.chunks_exact(3).flat_map(|p| [p[0], p[1], p[2], 255]).collect();
            assert_eq!(shown, expected);
        }
        assert!(decoder.read_next_frame().unwrap().is_none());
        assert_eq!(delays, [8, 8, 100]);
        assert_eq!(animation.encode(8, 100).unwrap(), bytes);
    }

    #[test]
    fn many_colours_become_near_ones() {
        let pixels: Vec<u8> = (0..64 * 64).flat_map(|i: u32| [(i % 64 * 4) as u8, (i / 64 * 4) as u8, 128]).collect();
        let palette = Palette::of(std::slice::from_ref(&pixels));
        assert_eq!(palette.0.len(), COLOURS);
        let mut found = HashMap::new();
        let same = palette.index(&palette.0[7], &mut found);
        assert_eq!(palette.0[same as usize], palette.0[7]);
        assert!(Animation::default().encode(1, 1).is_err());
    }
}
