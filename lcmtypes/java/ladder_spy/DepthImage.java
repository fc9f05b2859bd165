// SPDX-License-Identifier: BSD-3-Clause
package ladder_spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics2D;
import java.awt.image.BufferedImage;
import javax.swing.Action;
import javax.swing.JDesktopPane;

import ladder_msgs.tof_frame_t;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** lcm-spy plugin: the live depth image of a head; near is bright, no return is dark blue. The spy finds it in the jar. */
public final class DepthImage implements SpyPlugin {
    @Override
    public boolean canHandle(long fingerprint) {
        return fingerprint == tof_frame_t.LCM_FINGERPRINT;
    }

    @Override
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return LiveView.opener("Depth image", desktop, channel, View::new);
    }

    private static final class View extends LiveView {
        private static final int NO_RETURN = new Color(0, 0, 60).getRGB();

        View(ChannelData channel) {
            super(channel, 66, new Dimension(448, 342));
        }

        @Override
        protected void draw(Graphics2D graphics) {
            if (channel.last instanceof tof_frame_t) {
                graphics.drawImage(imageOf((tof_frame_t) channel.last), 0, 0, getWidth(), getHeight(), null);
            }
        }

        private static BufferedImage imageOf(tof_frame_t frame) {
            final int width = Math.max(frame.width_px, 1);
            final int height = Math.max(frame.height_px, 1);
            final BufferedImage image = new BufferedImage(width, height, BufferedImage.TYPE_INT_RGB);
            final int pixels = Math.min(frame.num_pixels, width * height);
            for (int i = 0; i < pixels; ++i) {
                image.setRGB(i % width, i / width, color(frame.depth_mm[i], frame.range_max_m));
            }
            return image;
        }

        private static int color(int depthMm, double rangeMaxM) {
            if (depthMm <= 0) return NO_RETURN;
            final double far = Math.min(1.0, 0.001 * depthMm / rangeMaxM);
            final int grey = (int) Math.round(255.0 * (1.0 - 0.9 * far));
            return new Color(grey, grey, grey).getRGB();
        }
    }
}
